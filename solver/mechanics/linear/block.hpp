// Storage of blocks of 8 x 8 of a factorisation A = L D L^T.
#pragma once

namespace myowave::solver {

inline constexpr int block_width = 8;  // doubles of the widest vector register

// Column by column: entry (r, q) at 8 q + r.
struct alignas(64) Block {
  double at[block_width * block_width];
};
struct alignas(64) BlockVector {
  double at[block_width];
};

}  // namespace myowave::solver
