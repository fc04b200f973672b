// Storage of tiles of 8 x 8 of a factorisation A = L D L^T.
#pragma once

namespace myowave::solver {

inline constexpr int tile_width = 8;  // doubles of the widest vector register

// Column by column: entry (r, q) at 8 q + r.
struct alignas(64) Tile {
  double at[tile_width * tile_width];
};
struct alignas(64) TileVector {
  double at[tile_width];
};

}  // namespace myowave::solver
