// Bytes and operations that one item (a node for a step, an entry, an element) costs if every array
// is read and written once and neighbours come from the cache. bench/TRAFFIC.md shows the same numbers.
#pragma once

namespace myowave::bench {

struct Traffic {
  double reads = 0;   // bytes
  double writes = 0;  // bytes
  // Bytes of lines that are only written: a host reads such a line first, a GPU does not.
  double allocates = 0;
  double flops = 0;  // additions, multiplications, divisions and comparisons that select

  constexpr double host_bytes() const { return reads + writes + allocates; }
  constexpr double device_bytes() const { return reads + writes; }
};

// f(V, r) 7, r_t 10, Ta_t 4 with its comparison, and 8 that add them to the old state.
inline constexpr double reaction_flops = 29;
inline constexpr double identity_flops = reaction_flops + 6;
inline constexpr double conservative_flops = reaction_flops + 24;
// f(V, r) 2 x 7, r 19, Ta 6 with its comparison, and 13 that add them to the state; nine points take 5
// operations more than five on the undeformed sheet, and none on a metric.
inline constexpr double split_reaction_flops = 52;
inline constexpr double identity_split_flops = split_reaction_flops + 11;
inline constexpr double conservative_split_flops = split_reaction_flops + 24;
inline constexpr double expanded_flops = reaction_flops + 26;

// V read, V_next written, r and Ta in place, and `coefficients` arrays.
template <class Real>
constexpr Traffic step_traffic(int coefficients, double flops) {
  constexpr double real = sizeof(Real);
  return {(3 + coefficients) * real, 3 * real, real, flops};
}

// V, r and Ta from old arrays to new ones, and the coefficients, once for `depth` steps.
template <class Real>
constexpr Traffic tiled_traffic(int coefficients, double flops, double depth) {
  constexpr double real = sizeof(Real);
  return {(3 + coefficients) * real / depth, 3 * real / depth, 3 * real / depth, flops};
}

// V, r and Ta from old arrays to new ones.
template <class Real>
constexpr Traffic plain_traffic(int coefficients, double flops) {
  constexpr double real = sizeof(Real);
  return {(3 + coefficients) * real, 3 * real, 3 * real, flops};
}

// A node: G11, G22, sqrt C and the diagonal written by the first pass; the first three read, three
// weights written by the second.
template <class Real>
constexpr Traffic conservative_refresh_traffic() {
  constexpr double real = sizeof(Real);
  return {3 * real, 7 * real, 7 * real, 65};
}

// A node: five coefficients written; the bounds read nodes only. Twice F, its inverse and C^-1.
template <class Real>
constexpr Traffic expanded_refresh_traffic() {
  constexpr double real = sizeof(Real);
  return {0, 5 * real, 5 * real, 120};
}

// An element: four values at each of four Gauss points read, four written.
template <class Real>
constexpr Traffic tension_traffic() {
  return {16 * sizeof(Real), 4 * sizeof(double), 4 * sizeof(double), 4 * 19};
}

// An element: a node's position and the tension read, 8 + 36 numbers written and read again, then 2
// and 19 of a node, the latter read again with the source (4 B) of about 18 slots of the tangent.
// Operations: 4 Gauss points with F 20, t and A 11, energy derivatives 40, P 16, A 70, rows 4 x 24, R
// 24, and the 36 entries with 4 each.
inline constexpr Traffic assemble_traffic{(2 + 4 + 44 + 19) * 8.0 + 18 * 4.0, (44 + 2 + 19 + 18) * 8.0,
                                          (44 + 2 + 19 + 18) * 8.0, 4 * 420.0};

// An element: positions and tension read, energy and smallest J written. Operations: 4 corners, and 4
// Gauss points of which the logarithm is 30.
inline constexpr Traffic energy_traffic{(2 + 4) * 8.0, 2 * 8, 2 * 8, 4 * 20 + 4 * 95.0};

// A node: V read; tips are rare.
template <class Real>
constexpr Traffic tips_traffic() {
  return {sizeof(Real), 0, 0, 4};
}

// A node: V, r, Ta read. Operations: 4 of the finite sum, 12 of the noise, 3 comparisons.
template <class Real>
constexpr Traffic state_check_traffic() {
  return {3 * sizeof(Real), 0, 0, 19};
}

// An element: two numbers of a node read, the area written.
inline constexpr Traffic area_traffic{16, 8, 8, 8};

// A node: V and its mark read twice from the cache, once from memory, the mark written; records are rare.
// Operations: the comparisons of nodes_that_tell and refresh_marks.
template <class Real>
constexpr Traffic activation_traffic() {
  return {sizeof(Real) + sizeof(float), sizeof(float), 0, 10};
}

}  // namespace myowave::bench
