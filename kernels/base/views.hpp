// The View types of the project. Layout (member, row, column), last index fastest, on every backend:
// neighbouring columns have neighbouring addresses.
#pragma once

#include <Kokkos_Core.hpp>

namespace myowave {

// A grid field of one member, shape (rows, columns).
template <class Real, class MemorySpace>
using Field = Kokkos::View<Real**, Kokkos::LayoutRight, MemorySpace>;

// A grid field of all members, shape (members, rows, columns).
template <class Real, class MemorySpace>
using EnsembleField = Kokkos::View<Real***, Kokkos::LayoutRight, MemorySpace>;

// Element nodes of one member, shape (nodes, 2); node = I (element columns + 1) + J.
template <class MemorySpace>
using Nodes = Kokkos::View<double* [2], Kokkos::LayoutRight, MemorySpace>;

// Active tension at the Gauss points of one member, shape (elements, 4), kPa. Gauss point
// q = 2 q2 + q1 at xi_1 = 1/2 -+ 1/(2 sqrt 3), xi_2 likewise: (q1, q2) = (0,0), (1,0), (0,1), (1,1).
template <class MemorySpace>
using GaussTension = Kokkos::View<double* [4], Kokkos::LayoutRight, MemorySpace>;

}  // namespace myowave
