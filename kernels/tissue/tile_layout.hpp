// How a sheet is divided for launches of several steps (tiled_step.hpp): tiles, passes, and the scratch
// memory of a tile.
#pragma once

#include <cstddef>
#include <type_traits>

#include "kernels/base/row_loop.hpp"
#include "kernels/tissue/stencil_rows.hpp"

namespace myowave::tissue {

// The nodes of a tile, the steps of a pass, and the passes of one launch. More than one pass needs tiles
// that are whole sheets; after an even number of passes the new state is in the arrays of the old one.
struct TileLayout {
  int rows = 1, columns = 1, depth = 1, passes = 1;
};

// Fronts from the load of a row to its first step, and from each step to the next. On a device all levels
// of a front run between two barriers: a level must not read what the one below writes at the same front.
// A host's team is one thread, so that a lag of 1 suffices, with fewer rows in scratch.
template <class ExecutionSpace>
inline constexpr int tile_lag = runs_on_host<ExecutionSpace> ? 1 : 2;

template <class ExecutionSpace, class Diffusion, class Model, int lag = tile_lag<ExecutionSpace>>
struct Tiling {
  using Real = typename Diffusion::Scalar;
  using Policy = Kokkos::TeamPolicy<ExecutionSpace>;
  static constexpr bool on_host = runs_on_host<ExecutionSpace>;

  // Fronts whose V is in scratch: at least the last lag + 2, and a power of two, so that the place of a row
  // needs no division.
  static constexpr int V_fronts = 4;
  static_assert(lag + 2 <= V_fronts);
  // Level 0 is the shared memory of a device's multiprocessor; a host's scratch stays in its cache.
  static constexpr int scratch_level = on_host ? 1 : 0;
  // Entries of a cache line. Scratch rows start at one: loads of unaligned vectors would cross two lines.
  static constexpr int line = detail::line_of<Real>;

  static constexpr int round_up(int columns) { return (columns + line - 1) / line * line; }
  // Rows of r, Ta and the metric in scratch.
  KOKKOS_FUNCTION static constexpr int slots_of(int depth) {
    int power = 1;
    while (power < lag * (depth - 1) + (without_metric ? 1 : 2)) power *= 2;
    return power;
  }
  // Wide tiles compute fewer columns twice. With the weights of edges in scratch too, a host's cache holds
  // only narrower rows.
  static constexpr bool without_metric = Diffusion::scratch_entries(1, 1) == 0;
  static constexpr int widest_bytes = on_host && without_metric ? 4096 : 2048;
  static constexpr int widest_tile = widest_bytes / static_cast<int>(sizeof(Real));
  static constexpr int deepest = on_host ? 20 : 15;
  // Entries from one scratch row to the next: the computed columns and at least one line for the neighbours
  // beyond both ends; an odd number of lines, because an even one maps rows to the same cache sets.
  static constexpr int pitch_of(int computed) { return line * ((1 + (computed + line - 1) / line) | 1); }
  static constexpr int most_computed(int columns, int depth) { return columns + 2 * (depth + line - 1); }
  static constexpr int widest_pitch = pitch_of(most_computed(widest_tile, deepest));
  // A constant on a device: rows at a fixed distance need no address of their own. On a host the rows of a
  // small sheet are packed: far apart they would be in more pages than the TLB holds.
  using Pitch = std::conditional_t<on_host, int, Constant<widest_pitch>>;
  static constexpr int state_arrays = Model::has_tension ? 2 : 1;
  // V, r and Ta, the metric; and a line before them.
  KOKKOS_FUNCTION static constexpr int scratch_entries(int depth, int pitch) {
    return line + V_fronts * array_entries<Real>(depth, pitch) +
           state_arrays * array_entries<Real>(slots_of(depth), pitch) +
           Diffusion::scratch_entries(slots_of(depth), pitch);
  }
  static constexpr std::size_t scratch_bytes(int depth, int pitch) {
    return static_cast<std::size_t>(scratch_entries(depth, pitch)) * sizeof(Real) + detail::line_bytes;
  }

  // On a device eight warps process a row, one column a lane; on a host a team is one thread.
  static constexpr int warps = on_host ? 1 : 8, lanes = on_host ? 1 : 32;

  // Owned nodes, half open, and the columns that are computed.
  struct Tile {
    int member, first_row, last_row, first_column, last_column;
    int origin;  // a multiple of `line`
    int width;   // a multiple of `line`; columns outside the sheet are computed too, on zeros
    int inside;  // columns inside the sheet
  };

  // The scratch rows of a team; every pointer is that of column `origin`. V is indexed by the front that
  // brought a row to its level, 0 (loaded) ... depth - 1; r, Ta and the metric by row modulo the slots.
  struct Rings {
    Real *V_begin, *r_begin, *metric_begin;
    int depth, slots;
    Pitch pitch;
    KOKKOS_FORCEINLINE_FUNCTION Real* V(int front, int level) const {
      return V_begin + (front & (V_fronts - 1)) * array_entries<Real>(depth, pitch) + level * pitch;
    }
    KOKKOS_FORCEINLINE_FUNCTION Real* r(int i) const { return r_begin + slot_of(i, slots) * pitch; }
    KOKKOS_FORCEINLINE_FUNCTION Real* Ta(int i) const { return r(i) + array_entries<Real>(slots, pitch); }
  };

  // The depth up to which more steps a launch are faster: on a host between 16 and 27, where the scratch rows
  // fit the 1 MiB second-level cache of an EPYC; on a device what two teams a multiprocessor can have.
  static int largest_depth() {
    if constexpr (on_host) return deepest;
    const std::size_t most = Policy::scratch_size_max(scratch_level) / 2;
    int depth = deepest;
    while (depth > 1 && scratch_bytes(depth, widest_pitch) > most) --depth;
    return depth;
  }

  // Cost of a pass besides its steps, in steps: it loads rows, and its first and last steps wait for memory.
  // Measured on an EPYC: 1.4 from a cache, up to 5 from memory.
  static constexpr double steps_of_loads = 3;

  // Tiles no wider than widest_tile, with as many rows each as keep all teams equally busy.
  static TileLayout choose_tiles(const ExecutionSpace& space, const Grid& grid, int members, int depth) {
    const int column_tiles = tiles_of(grid.columns, widest_tile);
    const int columns = column_tiles == 1 ? grid.columns : round_up(tiles_of(grid.columns, column_tiles));
    const double strips = static_cast<double>(members) * column_tiles;
    TileLayout best{grid.rows, columns, depth};
    double least = rows_of_a_team(space, grid, members, best);
    for (int row_tiles = 2; grid.rows / row_tiles >= 2 * depth; ++row_tiles) {
      // More tiles only add rows that are computed twice; even perfect balance cannot win.
      if (strips * (grid.rows + row_tiles * (depth - 1)) >= least * teams_of(space)) break;
      const TileLayout layout{tiles_of(grid.rows, row_tiles), columns, depth};
      const double cost = rows_of_a_team(space, grid, members, layout);
      if (cost < least) least = cost, best = layout;
    }
    return best;
  }

  // The number of passes in which `steps` take the least time: fewer passes load less, but where many teams
  // share a sheet most nodes of a deep tile belong to its neighbours.
  static int choose_passes(const ExecutionSpace& space, const Grid& grid, int members, int steps) {
    const int fewest = tiles_of(steps, largest_depth());
    if constexpr (!on_host) return fewest;
    int best = fewest;
    double least = 1e300;
    for (int passes = fewest; passes <= steps; passes *= 2) {
      const TileLayout layout = choose_tiles(space, grid, members, tiles_of(steps, passes));
      const int columns = layout.columns + (layout.columns < grid.columns ? 2 * layout.depth : 0);
      const double cost =
          passes * (layout.depth + steps_of_loads) * columns * rows_of_a_team(space, grid, members, layout);
      if (cost < least) least = cost, best = passes;
    }
    return best;
  }

  // Entries from one scratch row to the next, in tiles of `columns` owned columns.
  static Pitch pitch_in([[maybe_unused]] const Grid& grid, [[maybe_unused]] int columns,
                        [[maybe_unused]] int depth) {
    if constexpr (on_host)
      return pitch_of(Kokkos::min(grid.columns, most_computed(columns, depth)));
    else
      return {};
  }

  // Bytes of scratch memory a team. On a host the same for every layout, so that later launches do not
  // allocate; a device has too little for that.
  static std::size_t launch_bytes(const Grid& grid, const TileLayout& layout) {
    if constexpr (on_host) return scratch_bytes(deepest, pitch_in(grid, widest_tile, deepest));
    return scratch_bytes(layout.depth, pitch_in(grid, layout.columns, layout.depth));
  }

 private:
  static int teams_of(const ExecutionSpace& space) {
    return Kokkos::max(1, space.concurrency() / (warps * lanes));
  }

  // Rows that the busiest team computes in a step, with those of its neighbours: on average depth / 2 at each
  // end of a tile.
  static double rows_of_a_team(const ExecutionSpace& space, const Grid& grid, int members,
                               const TileLayout& layout) {
    const int row_tiles = tiles_of(grid.rows, layout.rows),
              column_tiles = tiles_of(grid.columns, layout.columns);
    return static_cast<double>(tiles_of(members * row_tiles * column_tiles, teams_of(space))) *
           (layout.rows + (row_tiles > 1 ? layout.depth - 1 : 0));
  }
};

}  // namespace myowave::tissue
