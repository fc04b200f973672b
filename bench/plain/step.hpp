// The yardstick of the excitation step: a careful implementation in C++ and OpenMP, without Kokkos. It does
// not change, so that ratios to it can be compared over the years.
//
// V, r and Ta go from old arrays to new ones. Fields are n x n, row-major. Parameters are those of
// Nash & Panfilov 2004 as kernels/cell/ has them, law "delayed".
#pragma once

#include <cstddef>
#include <cstdlib>
#include <memory>
#include <new>
#include <span>

namespace myowave::plain {

struct FreeMemory {
  void operator()(void* memory) const { std::free(memory); }
};

// Aligned to a cache line. Every thread first touches the part that it will use.
template <class Real>
class Array {
 public:
  Array() = default;
  explicit Array(std::size_t size);
  Real* data() const { return memory_.get(); }
  std::size_t size() const { return size_; }
  Real& operator[](std::size_t k) const { return memory_[k]; }

 private:
  std::unique_ptr<Real[], FreeMemory> memory_;
  std::size_t size_ = 0;
};

template <class Real>
struct Constants {
  Real dt = Real(0.02);  // t.u.
  Real dx = Real(0.6);   // length units
  Real D = 1, inverse_C_m = 1;
  Real k = 8, a = Real(0.1), b = Real(0.1), eps = Real(0.01), mu1 = Real(0.12), mu2 = Real(0.3);
  Real k_Ta = Real(47.9), eps_below = 1, eps_above = Real(0.1), threshold = Real(0.05);
};

template <class Real>
struct Fields {
  Array<Real> V, r, Ta;
  Fields() = default;
  explicit Fields(int n)
      : V(static_cast<std::size_t>(n) * n),
        r(static_cast<std::size_t>(n) * n),
        Ta(static_cast<std::size_t>(n) * n) {}
};

// The conservative form as a network of edges, one array a direction, (n + 1) x (n + 1): node or cell
// (i, j) at (i + 1, j + 1), zero outside the sheet.
template <class Real>
struct EdgeNetwork {
  int n = 0;
  Array<Real> east, north;      // (i,j)-(i,j+1), (i,j)-(i+1,j)
  Array<Real> rising, falling;  // (i,j)-(i+1,j+1), (i,j+1)-(i+1,j)
  Array<Real> inverse_mass;     // 1 / (M_i dx^2)

  EdgeNetwork() = default;
  explicit EdgeNetwork(int nodes_a_side);
  // From element nodes (x1, x2 of node 0, of node 1, ...) of square elements of `cells` cells a side.
  void refresh(int cells, double dx, std::span<const double> nodes);
};

enum class Threads { all, one };

template <class Real>
void step_identity(Threads, const Constants<Real>&, int n, const Fields<Real>& old, const Fields<Real>& next);

template <class Real>
void step_conservative(Threads, const Constants<Real>&, const EdgeNetwork<Real>&, const Fields<Real>& old,
                       const Fields<Real>& next);

}  // namespace myowave::plain
