// Sparse symmetric systems by others, which share nothing with solver/: Eigen, and CHOLMOD through Eigen.
#pragma once

#include <memory>
#include <span>
#include <vector>

namespace myowave::reference {

// Lower triangle in compressed rows, columns ascending.
struct SymmetricMatrix {
  std::vector<int> row_begin{0}, column;
  std::vector<double> values;

  int size() const { return static_cast<int>(row_begin.size()) - 1; }
};

// A x
std::vector<double> product(const SymmetricMatrix&, const std::vector<double>& x);

// By Eigen's dense solver, ascending: for sizes up to some hundred.
std::vector<double> eigenvalues(const SymmetricMatrix&);

class Ldlt {
 public:
  // Eigen's and CHOLMOD's simplicial L D L^T, and CHOLMOD's supernodal L L^T of definite matrices alone.
  enum class Library { eigen, cholmod, supernodal };

  // Analyses the pattern; the values are not used.
  Ldlt(Library, const SymmetricMatrix&);
  ~Ldlt();

  // Values in the order of the pattern. false: there is no factor.
  bool factorize(std::span<const double> values);
  std::vector<double> solve(const std::vector<double>& b);

  // Only the interface that the libraries share.
  struct Solver;

 private:
  std::unique_ptr<Solver> solver_;
};

}  // namespace myowave::reference
