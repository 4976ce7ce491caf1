// Where the ray meets the ground, or FAR.
float ground_distance() {
  if (frame.ground_radius_m <= 0.0LF) return FAR;
  dvec3 p = dvec3(ray_start.xy, ray_start.z * frame.ground_z_scale);
  dvec3 d = dvec3(ray_direction.xy, ray_direction.z * frame.ground_z_scale);
  double stretch = sqrt(dot(d, d)), r0 = sqrt(dot(p, p));
  double b = dot(p, d) / stretch, height = r0 - frame.ground_radius_m;
  double c = height * (r0 + frame.ground_radius_m), discriminant = b * b - c;
  if (b >= 0.0LF || discriminant < 0.0LF || height < -0.01LF) return FAR;
  return float(max(c / (-b + sqrt(discriminant)), 0.0LF) / stretch);
}
