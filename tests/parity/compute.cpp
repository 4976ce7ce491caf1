#include "compute.h"

#include <epoxy/gl.h>

#include <stdexcept>

extern const char* const nepho_shader_table;

namespace nepho::test {
namespace {

std::string info_log(unsigned object, decltype(glGetShaderiv) get,
                     decltype(glGetShaderInfoLog) read) {
  int length = 0;
  get(object, GL_INFO_LOG_LENGTH, &length);
  std::string text(std::size_t(length) + 1, '\0');
  read(object, length + 1, nullptr, text.data());
  return text;
}

// A mutant changes the shader alone: parity must see it.
std::string shader_text() {
  std::string text = nepho_shader_table;
#ifdef NEPHO_MUTANT_SHADER
  text.insert(text.find('\n') + 1, "#define NEPHO_MUTANT_USUAL_HG\n");
#endif
  return text;
}

// Lives as long as the test program's context: compiled once for all cases.
unsigned table_program() {
  static const unsigned made = [] {
    const unsigned shader = glCreateShader(GL_COMPUTE_SHADER);
    const std::string text = shader_text();
    const char* const start = text.c_str();
    glShaderSource(shader, 1, &start, nullptr);
    glCompileShader(shader);
    int good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (!good) throw std::runtime_error(info_log(shader, glGetShaderiv, glGetShaderInfoLog));
    const unsigned program = glCreateProgram();
    glAttachShader(program, shader);
    glLinkProgram(program);
    glDeleteShader(shader);
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (!good) throw std::runtime_error(info_log(program, glGetProgramiv, glGetProgramInfoLog));
    return program;
  }();
  return made;
}

class Buffer {
 public:
  Buffer(unsigned binding, std::size_t bytes, const void* data) {
    glCreateBuffers(1, &name_);
    glNamedBufferStorage(name_, GLsizeiptr(bytes), data, 0);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, name_);
  }
  ~Buffer() { glDeleteBuffers(1, &name_); }
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  template <typename T>
  void read(std::vector<T>& out) const {
    glGetNamedBufferSubData(name_, 0, GLsizeiptr(out.size() * sizeof(T)), out.data());
  }

 private:
  unsigned name_ = 0;
};

}  // namespace

std::vector<Outputs> evaluate_on_gpu(int which, std::span<const Row> rows) {
  std::vector<float> inputs;
  std::vector<int> indices;
  for (const Row& row : rows) {
    for (const double x : row.x) inputs.push_back(float(x));
    indices.insert(indices.end(), {which, row.wall, row.nearest});
  }
  // Not a number: a row that the shader did not write cannot pass.
  std::vector<float> results(3 * rows.size(), __builtin_nanf(""));
  const unsigned program = table_program();
  const Buffer input(0, inputs.size() * sizeof(float), inputs.data());
  const Buffer index(1, indices.size() * sizeof(int), indices.data());
  const Buffer output(2, results.size() * sizeof(float), results.data());
  glUseProgram(program);
  glUniform1ui(glGetUniformLocation(program, "rows"), unsigned(rows.size()));
  glDispatchCompute(unsigned(rows.size() + 63) / 64, 1, 1);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  output.read(results);
  if (const unsigned error = glGetError())
    throw std::runtime_error("OpenGL error " + std::to_string(error));
  std::vector<Outputs> out(rows.size());
  for (std::size_t row = 0; row < out.size(); ++row)
    for (std::size_t i = 0; i < 3; ++i) out[row][i] = double(results[3 * row + i]);
  return out;
}

}  // namespace nepho::test
