#include "gl/object.h"

#include <array>
#include <sstream>
#include <vector>

#include "core/error.h"

namespace nepho::gl {
namespace {

GLuint new_buffer() {
  GLuint id = 0;
  glCreateBuffers(1, &id);
  return id;
}

std::string info_log(GLuint id, bool is_program) {
  GLint length = 0;
  is_program ? glGetProgramiv(id, GL_INFO_LOG_LENGTH, &length)
             : glGetShaderiv(id, GL_INFO_LOG_LENGTH, &length);
  std::vector<char> text(std::size_t(length) + 1);
  is_program ? glGetProgramInfoLog(id, length, nullptr, text.data())
             : glGetShaderInfoLog(id, length, nullptr, text.data());
  return text.data();
}

[[noreturn]] void refuse(const std::string& name, const std::string& text) {
  throw Error({.what = "the OpenGL driver refused a shader",
               .where = name,
               .expected = {},
               .found = text,
               .hint = "please report it with the output of `nephoscope --version`"});
}

}  // namespace

Buffer::Buffer(const void* data, std::size_t bytes) : Name(new_buffer()), bytes_(bytes) {
  constexpr std::array<char, 16> kNothing{};
  if (bytes == 0)
    glNamedBufferStorage(id(), GLsizeiptr(kNothing.size()), kNothing.data(), 0);
  else
    glNamedBufferStorage(id(), GLsizeiptr(bytes), data, 0);
}

Program compile(const std::string& name, const char* source, const std::string& defines) {
  const std::string text = source;
  const std::size_t after_version = text.find('\n') + 1;
  const std::string whole = text.substr(0, after_version) + defines + text.substr(after_version);
  const char* pointer = whole.c_str();
  const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
  glShaderSource(shader, 1, &pointer, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (!good) {
    const std::string reason = info_log(shader, false);
    glDeleteShader(shader);
    refuse(name, reason);
  }
  Program program(glCreateProgram());
  glAttachShader(program.id(), shader);
  glLinkProgram(program.id());
  glDeleteShader(shader);
  glGetProgramiv(program.id(), GL_LINK_STATUS, &good);
  if (!good) refuse(name, info_log(program.id(), true));
  return program;
}

void check_errors(const char* where) {
  const GLenum error = glGetError();
  if (error == GL_NO_ERROR) return;
  std::ostringstream code;
  code << "OpenGL error 0x" << std::hex << error;
  throw Error({.what = "OpenGL failed",
               .where = where,
               .expected = {},
               .found = code.str(),
               .hint = error == GL_OUT_OF_MEMORY ? "lower --budget-mib or --size" : ""});
}

}  // namespace nepho::gl
