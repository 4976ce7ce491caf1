#version 450 core
layout(local_size_x = 1) in;
void main() {
  vec3 wrong = 1.0;  // a float is no vec3
}
