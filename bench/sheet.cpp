#include "bench/sheet.hpp"

#include <map>
#include <numbers>
#include <random>
#include <utility>

#include "kernels/transfer/tension_to_gauss.hpp"

namespace myowave::bench {
namespace {

// Eight random plane waves of 100 to 200 node spacings.
class Waves {
 public:
  explicit Waves(unsigned seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int n = 0; n < 8; ++n) {
      const double angle = 2 * std::numbers::pi * uniform(engine);
      const double k = 2 * std::numbers::pi / (100 + 100 * uniform(engine));
      waves_.push_back({k * std::cos(angle), k * std::sin(angle), 2 * std::numbers::pi * uniform(engine)});
    }
  }
  double operator()(int i, int j) const {
    double sum = 0;
    for (const auto& w : waves_) sum += std::cos(w.k1 * j + w.k2 * i + w.phase);
    return sum;
  }

 private:
  struct Wave {
    double k1, k2, phase;
  };
  std::vector<Wave> waves_;
};

// The angle of the point whose coordinates are two such fields. It winds around each common zero of the two,
// where a front becomes a spiral.
class Phases {
 public:
  // In [0, 2 pi).
  double operator()(int i, int j) const {
    const double angle = std::atan2(sine_(i, j), cosine_(i, j));
    return angle < 0 ? angle + 2 * std::numbers::pi : angle;
  }

 private:
  Waves sine_{1}, cosine_{2};
};

constexpr int scene_n = 251;
// Spirals die in sheets smaller than the scene's, so a smaller sheet is a window of this one.
constexpr int window_of = 301;

// A rigid sheet in which spirals have settled.
class RigidSheet {
 public:
  using View = EnsembleField<float, MemorySpace>;

  explicit RigidSheet(int n)
      : diffusion_(square_grid(n)),
        model_(solver::make_model<float>(turbulent_excitation(), {})),
        V_("myowave::bench::V", 1, n, n),
        V_next_("myowave::bench::V_next", 1, n, n),
        r_("myowave::bench::r", 1, n, n),
        Ta_("myowave::bench::Ta", 1, n, n) {
    if (n == scene_n)
      start_as_the_scene();
    else
      start_with_spirals();
  }

  void advance(int steps) {
    for (int n = 0; n < steps; ++n) {
      tissue::monodomain_step(ExecutionSpace(), diffusion_, model_, dt, V_, r_, Ta_, V_next_);
      std::swap(V_, V_next_);
    }
    Kokkos::fence("myowave::bench::advance");
  }

  // Of the first n rows and columns.
  solver::InitialState state(int n) const {
    const auto window = [n](const View& view) {
      const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace{}, view);
      std::vector<double> values;
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) values.push_back(host(0, i, j));
      return values;
    };
    return {n, n, window(V_), window(r_), window(Ta_)};
  }
  const View& Ta() const { return Ta_; }

 private:
  // apps/scenes/contracting_turbulence.toml: one broken front that breaks up within 900 t.u.
  void start_as_the_scene() {
    constexpr int middle = (scene_n - 1) / 2, width = 10, steps = 45'000;
    fill(V_, [](int i, int j) { return middle - width < j && j <= middle && i <= middle ? 1.0F : 0.0F; });
    fill(r_, [](int, int j) { return j <= middle - width ? 1.5F : 0.0F; });
    advance(steps);
  }

  // With growing angle: excited, refractory, at rest. After 80 t.u. these are spirals.
  void start_with_spirals() {
    constexpr int steps = 4000;
    const Phases phase;
    fill(V_, [&](int i, int j) { return phase(i, j) < 0.7 ? 1.0F : 0.0F; });
    fill(r_, [&](int i, int j) { return phase(i, j) >= 0.7 && phase(i, j) < 3.5 ? 1.5F : 0.0F; });
    advance(steps);
  }

  tissue::IdentityDiffusion<float, MemorySpace> diffusion_;
  solver::Model<float> model_;
  View V_, V_next_, r_, Ta_;
};

constexpr int interval = 80;  // steps between solves

}  // namespace

solver::ExcitationSettings turbulent_excitation() {
  solver::ExcitationSettings excitation;
  excitation.mu1 = 0.07;
  return excitation;
}

const solver::InitialState& turbulent_state(int n) {
  static std::map<int, solver::InitialState> known;
  const auto found = known.find(n);
  if (found != known.end()) return found->second;
  RigidSheet sheet(n < scene_n ? window_of : n);
  return known[n] = sheet.state(n);
}

const std::vector<std::vector<double>>& turbulent_tension(int elements_a_side) {
  static std::map<int, std::vector<std::vector<double>>> known;
  auto& sequence = known[elements_a_side];
  if (!sequence.empty()) return sequence;
  const int n = cells_per_element * elements_a_side + 1, instants = elements_a_side > 50 ? 4 : 10;
  const auto elements = square_elements(n);
  const GaussTension<MemorySpace> gauss("myowave::bench::gauss_tension", elements.elements());
  RigidSheet sheet(n < scene_n ? window_of : n);
  for (int instant = 0; instant < instants; ++instant) {
    transfer::tension_to_gauss<ExecutionSpace, float>(ExecutionSpace(), elements, cells_per_element,
                                                      sheet.Ta(), 0, gauss);
    sequence.push_back(to_host(gauss));
    sheet.advance(interval);
  }
  return sequence;
}

GaussTension<MemorySpace> to_gauss_tension(const std::vector<double>& values) {
  const GaussTension<MemorySpace> gauss("myowave::bench::gauss_tension",
                                        values.size() / elastic::gauss_points);
  Kokkos::deep_copy(gauss, Kokkos::View<const double* [4], Kokkos::LayoutRight, Kokkos::HostSpace>(
                               values.data(), values.size() / elastic::gauss_points));
  return gauss;
}

}  // namespace myowave::bench
