// The linear system and the whole solve, by elements a side:
//   factorize | triangular_solve | analyze / E      newton / solve | plain / E
//   factorize | triangular_solve / eigen | cholmod | supernodal / E: the same by others
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bench/plain/newton.hpp"
#include "bench/sheet.hpp"
#include "bench/suite.hpp"
#include "solver/mechanics/equilibrium.hpp"
#include "solver/mechanics/linear/direct_solver.hpp"
#include "solver/mechanics/mesh.hpp"
#include "solver/mechanics/sparse_system.hpp"
#include "tests/support/reference_ldlt.hpp"
#include "tests/support/reference_mechanics.hpp"

namespace myowave::bench {
namespace {

constexpr int small_mesh = 12;
constexpr int largest_quick_mesh = 100;

elastic::ElementGrid mesh_of(int elements) { return square_elements(cells_per_element * elements + 1); }

solver::Mesh make_mesh(int elements) { return solver::make_mesh(mesh_of(elements), solver::Edges::load); }

// The tangent of a turbulent sheet in equilibrium.
struct LinearSystem {
  solver::Mesh mesh;
  std::vector<double> values, rhs;

  explicit LinearSystem(int elements) : mesh(make_mesh(elements)) {
    const solver::MechanicsSettings settings;
    const auto Ta = to_gauss_tension(turbulent_tension(elements)[0]);
    solver::Equilibrium<ExecutionSpace> equilibrium(ExecutionSpace(), mesh.grid, settings);
    equilibrium.solve(ExecutionSpace(), Ta, 0);
    solver::SparseSystem<ExecutionSpace> system(ExecutionSpace(), mesh);
    const elastic::Membrane membrane{.passive = settings, .load = {.follower = settings.p}};
    system.assemble(ExecutionSpace(), membrane, mesh.grid, equilibrium.nodes(), Ta);
    const auto tangent = system.tangent(0);
    values.assign(tangent.begin(), tangent.end());
    for (int a = 0; a < mesh.unknowns; ++a) rhs.push_back(std::sin(0.37 * a));
  }

  reference::SymmetricMatrix matrix() const { return {mesh.row_begin, mesh.column, values}; }

  // max|A x - b| / max|b|
  double relative_residual(const std::vector<double>& x) const {
    const std::vector<double> left = product(matrix(), x);
    double largest = 0;
    for (std::size_t a = 0; a < x.size(); ++a) largest = std::max(largest, std::abs(left[a] - rhs[a]));
    return largest;
  }
};

void report_unknowns(benchmark::State& state, double seconds, int unknowns) {
  state.counters["unknowns"] = unknowns;
  state.counters["unknowns_per_s"] =
      static_cast<double>(unknowns) * static_cast<double>(state.iterations()) / seconds;
}

void check_solution(benchmark::State& state, const LinearSystem& system, const std::vector<double>& x) {
  const double residual = system.relative_residual(x);
  if (!(residual <= 1e-9)) fail(state, fmt::format("the solution leaves a residual of {}", residual));
}

void time_analyze(benchmark::State& state, int elements) {
  const solver::Mesh mesh = make_mesh(elements);
  const double seconds = measure(state, 1, [&] { solver::DirectSolver(mesh.row_begin, mesh.column); });
  report_unknowns(state, seconds, mesh.unknowns);
}

void time_factorize(benchmark::State& state, int elements) {
  const LinearSystem system(elements);
  solver::DirectSolver solver(system.mesh.row_begin, system.mesh.column);
  const double seconds = measure(state, 1, [&] { solver.factorize(system.values); });
  report_unknowns(state, seconds, system.mesh.unknowns);
  std::vector<double> x(system.rhs.size());
  solver.solve(system.rhs, x);
  check_solution(state, system, x);
}

void time_triangular_solve(benchmark::State& state, int elements) {
  const LinearSystem system(elements);
  solver::DirectSolver solver(system.mesh.row_begin, system.mesh.column);
  solver.factorize(system.values);
  std::vector<double> x(system.rhs.size());
  const double seconds = measure(state, 1, [&] { solver.solve(system.rhs, x); });
  report_unknowns(state, seconds, system.mesh.unknowns);
  check_solution(state, system, x);
}

// The same system by Eigen, and by CHOLMOD through it.
struct OtherSolver {
  const char* name;
  reference::Ldlt::Library library;
};
constexpr OtherSolver other_solvers[] = {{"eigen", reference::Ldlt::Library::eigen},
                                         {"cholmod", reference::Ldlt::Library::cholmod},
                                         {"supernodal", reference::Ldlt::Library::supernodal}};

void time_other_factorize(benchmark::State& state, int elements, reference::Ldlt::Library library) {
  const LinearSystem system(elements);
  reference::Ldlt solver(library, system.matrix());
  const double seconds = measure(state, 1, [&] { solver.factorize(system.values); });
  report_unknowns(state, seconds, system.mesh.unknowns);
  check_solution(state, system, solver.solve(system.rhs));
}

void time_other_triangular_solve(benchmark::State& state, int elements, reference::Ldlt::Library library) {
  const LinearSystem system(elements);
  reference::Ldlt solver(library, system.matrix());
  solver.factorize(system.values);
  std::vector<double> x;
  const double seconds = measure(state, 1, [&] { x = solver.solve(system.rhs); });
  report_unknowns(state, seconds, system.mesh.unknowns);
  check_solution(state, system, x);
}

// The turbulent tensions forwards and backwards, so that every solve starts one interval from its solution.
class Sequence {
 public:
  explicit Sequence(int elements) {
    const auto& forth = turbulent_tension(elements);
    for (const auto& Ta : forth) instants_.push_back(&Ta);
    for (std::size_t k = forth.size() - 1; k-- > 1;) instants_.push_back(&forth[k]);
  }
  int length() const { return static_cast<int>(instants_.size()); }
  const std::vector<double>& next() { return *instants_[at_ = (at_ + 1) % instants_.size()]; }
  const std::vector<double>& current() const { return *instants_[at_]; }

 private:
  std::vector<const std::vector<double>*> instants_;
  std::size_t at_ = 0;
};

// Checks by the tests' reference that the residual of the unknowns is below the tolerance.
void check_equilibrium(benchmark::State& state, const elastic::ElementGrid& grid,
                       const std::vector<double>& Ta, const std::vector<double>& x) {
  const solver::MechanicsSettings settings;
  const reference::Mesh mesh{grid.rows, grid.columns, grid.h};
  const auto residual = reference::residual(mesh, settings, Ta, x);
  const auto held = reference::held_coordinates(mesh, settings);
  constexpr double stress_unit = 10;  // kPa
  double largest = 0;
  for (std::size_t a = 0; a < residual.size(); ++a)
    if (!held[a]) largest = std::max(largest, std::abs(residual[a]));
  largest /= stress_unit * grid.h;
  if (!(largest <= 1.1 * settings.tolerance)) fail(state, fmt::format("the residual is {}", largest));
}

// One iteration is one solve, a batch the whole sequence.
void time_newton(benchmark::State& state, int elements) {
  Sequence sequence(elements);
  std::vector<GaussTension<MemorySpace>> tension;
  for (int k = 0; k < sequence.length(); ++k) tension.push_back(to_gauss_tension(sequence.next()));
  solver::Equilibrium<ExecutionSpace> equilibrium(ExecutionSpace(), mesh_of(elements), {});
  double iterations = 0, factorizations = 0, solves = 0;
  solver::PhaseTimes time;
  std::size_t at = 0;
  equilibrium.solve(ExecutionSpace(), tension[at], 0);  // the cold start, which the counters leave out
  measure(state, sequence.length(), [&] {
    at = (at + 1) % tension.size();
    const auto done = equilibrium.solve(ExecutionSpace(), tension[at], 0);
    iterations += static_cast<double>(done.iterations);
    factorizations += static_cast<double>(done.factorizations);
    time += done.time;
    ++solves;
  });
  state.counters["unknowns"] = make_mesh(elements).unknowns;
  state.counters["iterations"] = iterations / solves;
  state.counters["factorizations"] = factorizations / solves;
  state.counters["assemble_s"] = time.assemble / solves;
  state.counters["factorize_s"] = time.factorize / solves;
  state.counters["triangular_s"] = time.triangular / solves;
  state.counters["energy_s"] = time.energy / solves;

  const auto nodes = to_host(equilibrium.nodes());
  check_equilibrium(state, equilibrium.grid(), to_host(tension[at]), nodes);

  // The yardstick reaches the same equilibrium on its own path.
  plain::Newton yardstick(equilibrium.grid(), {});
  yardstick.solve(to_host(tension[at]));
  double distance = 0;
  for (std::size_t a = 0; a < nodes.size(); ++a)
    distance = std::max(distance, std::abs(nodes[a] - yardstick.nodes()[a]));
  // Uncertainty of the nodes at this tolerance of the residual, mostly a slow bending of the whole sheet.
  const double open = 1e-5 * equilibrium.grid().h * elements;
  if (!(distance <= open)) fail(state, fmt::format("the yardstick's nodes are {} away", distance));
}

void time_plain_newton(benchmark::State& state, int elements) {
  Sequence sequence(elements);
  plain::Newton newton(mesh_of(elements), {});
  measure(state, sequence.length(), [&] { newton.solve(sequence.next()); });
  check_equilibrium(state, mesh_of(elements), sequence.current(), newton.nodes());
  const auto& effort = newton.effort();
  const auto solves = static_cast<double>(effort.solves);
  state.counters["unknowns"] = make_mesh(elements).unknowns;
  state.counters["iterations"] = static_cast<double>(effort.iterations) / solves;
  state.counters["factorizations"] = static_cast<double>(effort.factorizations) / solves;
  state.counters["assemble_s"] = effort.assemble_s / solves;
  state.counters["factorize_s"] = effort.factorize_s / solves;
  state.counters["triangular_s"] = effort.solve_s / solves;
  state.counters["energy_s"] = effort.energy_s / solves;
}

}  // namespace

void register_solve(const Suite& suite) {
  for (const int elements : suite.sizes({12, 25, 50, 100, 250}, small_mesh)) {
    if (elements > largest_quick_mesh && !suite.large) continue;
    const auto add = [=](const std::string& name, const auto& body) {
      add_row(fmt::format("{}/{}", name, elements), [=](benchmark::State& state) { body(state, elements); });
    };
    add("analyze", time_analyze);
    add("factorize", time_factorize);
    add("triangular_solve", time_triangular_solve);
    for (const auto& [name, library] : other_solvers) {
      const auto by = [=, library = library](const auto& body) {
        return [=](benchmark::State& state, int n) { body(state, n, library); };
      };
      add(fmt::format("factorize/{}", name), by(time_other_factorize));
      add(fmt::format("triangular_solve/{}", name), by(time_other_triangular_solve));
    }
    add("newton/plain", time_plain_newton);
    add("newton/solve", time_newton);
  }
}

}  // namespace myowave::bench
