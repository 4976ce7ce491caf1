// Steps as long as the tolerance allows. A step is two halves; in each, Simpson gives the optical
// depth, and the source is linear in it. The same over the whole step, from every second sample,
// tells by how much the halves may be off; what a linear source leaves goes with the cube of optical
// depth, and is extrapolated away. A step whose doubt is above the budget is tried again, shorter.

// Of the tolerance, what a step may be in doubt of: this part of its own light, and of all before it;
// where steps are many, a smaller part of that.
const float DOUBT_OF_STEP = 1.0;
float doubt_of_ray() { return clamp(0.1 * pow(1e4 * frame.tolerance, 1.0 / 6.0), 0.1, 0.2); }
// A doubt is that of the longer steps: what is left is this part of it.
const float LEFT_OF_DEPTH = 0.5, LEFT_OF_SOURCE = 0.3;
// Of a change of the source over a part that holds all of the depth, what a line may be off.
const float BLIND = 0.1;
// Light that counts as if it were there already: a ray of less optical depth is hardly seen.
const float FAINT = 0.005;
// Voxels in a step at most: where there was nothing, no hat may fall between two samples.
float longest_in_clear() { return clamp(4.0 * sqrt(sqrt(100.0 * frame.tolerance)), 1.0, 4.0); }
const float LONGEST = 12.0;

// Where a step is split: not in the middle, or all samples of a step that is as long as some cells
// would lie on their walls, where a field looks smoother than it is between them. The weights of the
// whole step's depth are those of the parabola through its ends and there.
#ifdef NEPHO_MUTANT_EVEN_SPLIT
const float SPLIT = 0.5;
#else
const float SPLIT = 0.45;
#endif
const float OF_FIRST = 0.5 - 1.0 / (6.0 * SPLIT), OF_LAST = 0.5 - 1.0 / (6.0 * (1.0 - SPLIT));
const float OF_MIDDLE = 1.0 / (6.0 * SPLIT * (1.0 - SPLIT));

float luminance_of(vec3 c) { return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b; }

// Radiance of the sky behind, where it is known: an error of the transmittance counts for so much.
float behind = 0.0;

void march_segment(inout Seen seen, float t, float end, bool smooth_) {
  float voxel = cell_length(0.5 * (t + end));
  begin_segment(t, end);
  while (t < end) {
    float most = smooth_ ? FAR : (march.k0 > 0.0 ? LONGEST : longest_in_clear()) * voxel;
    float asked = max(min(march.longest, most), 4.0 * least_step(t)), ahead = end - t;
    // The last step ends on the wall itself, and no step is a small remainder.
    bool last = ahead < 1.1 * asked;
    // Where cloud may begin, a step of no length gives what is there.
    bool fresh = march.fresh;
    float step_m = fresh ? 0.0 : last ? ahead : ahead < 2.0 * asked ? 0.5 * ahead : asked;
    float next_t = last && !fresh ? end : t + step_m;
    step_m = next_t - t;
    float first_m = SPLIT * step_m, second_m = step_m - first_m;
    float ka = total_extinction_at(t + 0.5 * first_m), km = total_extinction_at(t + first_m);
    vec3 sm = total_source_at(t + first_m);
    float kb = total_extinction_at(next_t - 0.5 * second_m), k1 = total_extinction_at(next_t);
    vec3 s1 = total_source_at(next_t);
#ifdef NEPHO_COUNT_SAMPLES
    extinction_count += 4u;
    source_count += 2u;
#endif
    float x1 = simpson_optical_depth(march.k0, ka, km, first_m);
    float x2 = simpson_optical_depth(km, kb, k1, second_m), x = x1 + x2;
    float through1 = exp(-x1), through2 = exp(-x2), through = through1 * through2, mean, of_half;
    vec3 whole = linear_light(march.s0, s1, x, through, mean);
    vec3 halves = linear_light(march.s0, sm, x1, through1, of_half) +
                  through1 * linear_light(sm, s1, x2, through2, of_half);
    float split = x > 0.0 ? (x1 / x) * (x2 / x) : 0.25;
    float rest = clamp((1.0 - 3.0 * split) / max(3.0 * split, 0.25), 0.0, 0.5);
    vec3 light = max(halves + rest * (halves - whole), vec3(0.0));
    float here = passed(seen);
    float bright = max(max(luminance_of(march.s0), luminance_of(sm)), luminance_of(s1));
    float lost = abs(step_m * (OF_FIRST * march.k0 + OF_MIDDLE * km + OF_LAST * k1) - x);
#ifdef NEPHO_MUTANT_TRUSTING
    lost *= 0.1;
    whole = mix(halves, whole, 0.1);
#endif
    float doubt = here * (LEFT_OF_SOURCE * luminance_of(abs(halves - whole)) + LEFT_OF_DEPTH * min(lost, 1.0) * max(bright, behind));
    // Where one part holds nearly all of the depth, whole and halves agree, whatever the source does there.
    float even = 4.0 * split, blind = (1.0 - even) * (1.0 - even);
    vec3 across = x2 > x1 ? s1 - sm : sm - march.s0;
    doubt += here * blind * blind * BLIND * min(x, 1.0) * luminance_of(abs(across));
    float budget = frame.tolerance * (DOUBT_OF_STEP * here * luminance_of(halves) +
                   doubt_of_ray() * (luminance_of(seen.radiance) + here * max(FAINT * bright, through * behind)));
    // Its error goes with the cube of its length.
    float by = 0.9 * pow(budget / max(doubt, 1e-30), 1.0 / 3.0);
    // Thicker, and the source at three places says too little of it; less of it is seen behind cloud.
    float thickest = min(2.0 * inversesqrt(max(here, 1e-6)), 10.0);
    if (x > thickest) by = min(by, thickest / x);
    if ((doubt > budget || x > thickest) && step_m > 4.0 * least_step(t)) {
      march.longest = step_m * clamp(by, 0.15, 0.7);
    } else {
      add_step(seen, light, x, through, mean, t, step_m);
      float grown = step_m * clamp(by, 0.5, 2.0);
      // A step that ended at a wall tells nothing against longer ones.
      march.longest = step_m < 0.9 * asked ? max(grown, march.longest) : grown;
      if (fresh) march.longest = longest_in_clear() * voxel;
      march.longest = min(march.longest, k1 > 0.0 ? 0.9 * thickest / k1 : FAR);
      march.s0 = s1;
      march.k0 = k1;
      // A float cannot hold a step below its own spacing: then the ray is done with this segment.
      if (next_t <= t && !fresh) break;
      march.fresh = false;
      t = next_t;
      if (passed(seen) < frame.least_transmittance) break;
    }
  }
}
