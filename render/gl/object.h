#pragma once

#include <epoxy/gl.h>

#include <cstddef>
#include <span>
#include <string>
#include <utility>

namespace nepho::gl {

// Move-only owners of OpenGL names. They need a current context to be made and to be destroyed.

template <auto Delete>
class Name {
 public:
  Name() = default;
  explicit Name(GLuint id) : id_(id) {}
  Name(Name&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Name& operator=(Name&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Name() {
    if (id_) Delete(id_);
  }
  GLuint id() const { return id_; }

 private:
  GLuint id_ = 0;
};

namespace detail {
inline void delete_buffer(GLuint id) {
  glDeleteBuffers(1, &id);
}
inline void delete_texture(GLuint id) {
  glDeleteTextures(1, &id);
}
inline void delete_program(GLuint id) {
  glDeleteProgram(id);
}
}  // namespace detail

using Texture = Name<detail::delete_texture>;
using Program = Name<detail::delete_program>;

class Buffer : public Name<detail::delete_buffer> {
 public:
  Buffer() = default;
  // Immutable, filled once. Never of size 0: shaders may then bind it whatever the scene.
  Buffer(const void* data, std::size_t bytes);
  template <class T>
  explicit Buffer(std::span<const T> data) : Buffer(data.data(), data.size_bytes()) {}
  std::size_t bytes() const { return bytes_; }
  void bind(GLuint binding) const { glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, id()); }

 private:
  std::size_t bytes_ = 0;
};

// Compiles a flattened compute shader with `defines` (lines of #define) after its #version. Throws
// Error with the compiler's text, which names files by the numbers at the shader's head.
Program compile(const std::string& name, const char* source, const std::string& defines);

// Throws Error where OpenGL reports one since the last call.
void check_errors(const char* where);

}  // namespace nepho::gl
