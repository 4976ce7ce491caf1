#pragma once

namespace nepho {

// Draine (2003, doi:10.1086/379118): Henyey-Greenstein times 1 + alpha mu^2, normalised; 1/sr.
double draine_phase(double one_minus_cos, double g, double alpha);

// "HG + Draine": the fit of Jendersie and d'Eon (2023, doi:10.1145/3587421.3595409) to water
// droplets, the same for all colours. An approximation of the Mie table: its forward peak is
// droplets', but its asymmetry is 0.012 to 0.019 too high (0.879 rather than 0.864 at 10 um), so
// that slabs reflect 16 % less at optical depth 1 and 1 % less at 128; fogbow and glory are 3 to 6
// times too faint.
struct HgDraine {
  double peak_asymmetry = 0;  // of Henyey-Greenstein
  double draine_asymmetry = 0, alpha = 0;
  double draine_part = 0;  // 0 .. 1

  double value(double one_minus_cos) const;  // 1/sr
  double asymmetry() const;                  // mean cosine
};

// Throws Error where the effective radius is outside 2.5 .. 25 um, for which the fit was made.
HgDraine hg_draine_fit(double effective_radius_m);

}  // namespace nepho
