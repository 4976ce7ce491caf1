// Sets the ray of a pixel; row 0 is at the top.
void begin_camera_ray(ivec2 pixel) {
  double x = (2.0LF * double(pixel.x) + 1.0LF) / double(frame.width) - 1.0LF;
  double y = 1.0LF - (2.0LF * double(pixel.y) + 1.0LF) / double(frame.height);
  ray_start = vec_of(frame.eye_m);
  ray_direction = vec_of(frame.forward) + x * vec_of(frame.right) + y * vec_of(frame.up);
  ray_direction /= sqrt(dot(ray_direction, ray_direction));
}
