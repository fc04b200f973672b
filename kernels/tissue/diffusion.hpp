// The diffusion term of Eq 22a, (1/sqrt C) (sqrt C C^-1_ML V_,L)_,M, in the three forms that a scene
// can select. Each form has
//   row(rows, m, i, origin)  of row i, r(j - 1, j, j + 1), with columns counted from `origin`: what a
//                            SIMD loop needs; r.prefetch(j)
//   at(V, m, i, j)           the same at any node, boundaries included; V of shape (members, rows, columns)
//   mirrored_edges           whether row() holds at the edges too, on mirrored neighbours
//   mirrors                  whether these count: edges to outside the sheet have zero weight, and V there
//   need
//                            only be finite
//   metric_rows(...)         row() for a team that moves up the rows; it copies its weights to
//                            scratch_entries(slots, pitch) of scratch memory; rows_in_memory(i, rows) lists
//                            the rows that row i reads from metric_arrays arrays
#pragma once

#include "kernels/tissue/conservative_diffusion.hpp"
#include "kernels/tissue/expanded_diffusion.hpp"
#include "kernels/tissue/identity_diffusion.hpp"
