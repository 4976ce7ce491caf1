#include "reference/path/medium.h"

namespace nepho {
namespace {

constexpr double kFaint = 0.125;  // transmittance below which roulette is played
constexpr double kRounding = 1 + 1e-9;

}  // namespace

PathMedium::PathMedium(const Forest& forest) {
  for (const VolumeTree& tree : forest.volumes) volumes_.push_back(std::make_unique<Leaves>(tree));
}

template <class Fn>
auto PathMedium::with_ray(std::size_t volume, const Ray& ray, Fn&& fn) const {
  const VolumeInfo& info = volumes_[volume]->info();
  const Index3& cells = info.lattice.cells(info.lattice.max_level());
  if (info.chart->kind() == ChartKind::kBox)
    return fn(BoxRay(static_cast<const BoxChart&>(*info.chart), cells, ray));
  return fn(ShellRay(static_cast<const ShellChart&>(*info.chart), cells, ray));
}

template <class Kind>
PathMedium::Collision PathMedium::collide_in(std::size_t volume, const Kind& ray, double t_max_m,
                                             Random& random) const {
  Collision found;
  Trials trials(random);
  follow(*volumes_[volume], ray, t_max_m,
         [&](double t0_m, double t1_m, int root, const ChartRay::Block& block,
             const Leaves::Leaf& leaf) {
           if (leaf.kind == NodeKind::kEmpty) return true;
           double t_m = t0_m;
           while (trials.next(t_m, t1_m, leaf.most_per_m)) {
             if (leaf.kind != NodeKind::kConstant) {
               const glm::dvec3 at = ray.cells_at(root, t_m);
               const double extinction = leaf.extinction_per_m(block, at);
               if (extinction > leaf.most_per_m * kRounding) ++violations_;
               if (random.uniform() * leaf.most_per_m >= extinction) continue;
               const double ice = leaf.ice_part(block, at);
               found.ice = ice > 0 && random.uniform() < ice;
             }
             found.t_m = t_m;
             found.volume = int(volume);
             return false;
           }
           return true;
         });
  return found;
}

PathMedium::Collision PathMedium::collide(const Ray& ray, double t_max_m, Random& random) const {
  Collision first{.t_m = t_max_m};
  for (std::size_t v = 0; v < volumes_.size(); ++v) {
    const Collision own =
        with_ray(v, ray, [&](const auto& kind) { return collide_in(v, kind, first.t_m, random); });
    if (own.volume >= 0) first = own;
  }
  if (first.volume < 0) first.t_m = kNoDistance_m;
  return first;
}

template <class Kind>
double PathMedium::pass(std::size_t volume, const Kind& ray, double t_max_m, double passed,
                        Random& random) const {
  Trials trials(random);
  // After each trial: a leaf may be hundreds of optical depths thick. What is left in the end is 0
  // or kFaint, with the same noise as if it were asked at the leaf's end.
  const auto goes_on = [&] {
    if (passed >= kFaint) return true;
#if defined(NEPHO_MUTANT_ROULETTE_FOR_NOTHING)
    passed = random.uniform() * kFaint < passed ? passed : 0;
#else
    passed = random.uniform() * kFaint < passed ? kFaint : 0;
#endif
    return passed > 0;
  };
  follow(*volumes_[volume], ray, t_max_m,
         [&](double t0_m, double t1_m, int root, const ChartRay::Block& block,
             const Leaves::Leaf& leaf) {
           if (leaf.kind == NodeKind::kEmpty) return true;
           if (leaf.kind == NodeKind::kConstant) {
             passed *= std::exp(-leaf.most_per_m * (t1_m - t0_m));
             return goes_on();
           }
           double t_m = t0_m;
           while (trials.next(t_m, t1_m, leaf.most_per_m)) {
             const double extinction = leaf.extinction_per_m(block, ray.cells_at(root, t_m));
             if (extinction > leaf.most_per_m * kRounding) ++violations_;
             passed *= std::max(0.0, 1 - extinction / leaf.most_per_m);
             if (!goes_on()) return false;
           }
           return true;
         });
  return passed;
}

double PathMedium::transmittance(const Ray& ray, double t_max_m, Random& random) const {
  double passed = 1;
  for (std::size_t v = 0; v < volumes_.size() && passed > 0; ++v)
    passed =
        with_ray(v, ray, [&](const auto& kind) { return pass(v, kind, t_max_m, passed, random); });
  return passed;
}

}  // namespace nepho
