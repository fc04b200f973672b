// Several explicit steps in one launch, bitwise identical to single ones: while the metric is held, a tile of
// the sheet can take `depth` steps without going back to memory.
//
// A team owns the nodes of a tile and moves up its rows like a wave: at front f it loads row f and
// takes step `level` = 1 ... depth on row f - lag level. The few rows in flight stay in the team's scratch
// memory; every row of the sheet is read once and written once. Neighbours that other tiles own are computed
// again: a tile starts `depth` rows and columns outside, and each step invalidates one of them. Old and new
// state must be different arrays, because other tiles read the old one. A tile that is a whole sheet has no
// such neighbours and takes several passes of `depth` steps, from one array to the other and back, while its
// member of an ensemble is in the cache.
//
//   view             shape                      unit   access
//   V, r             (members, rows, columns)   -      read; with several passes also write
//   Ta               (members, rows, columns)   kPa    read; with several passes also write
//   V_next, r_next   (members, rows, columns)   -      write; with several passes also read
//   Ta_next          (members, rows, columns)   kPa    write; with several passes also read
#pragma once

#include "kernels/tissue/row_update.hpp"
#include "kernels/tissue/tile_layout.hpp"

namespace myowave::tissue {

// V, r and Ta of all members; without tension Ta is empty.
template <class View>
struct ExcitationFields {
  View V, r, Ta;
};

// Called with V and r of the owned nodes before each step; records nothing.
struct NoRecorder {
  template <class Columns, class Real>
  KOKKOS_FUNCTION void operator()(const Columns&, int /*m*/, int /*i*/, int /*step*/, int /*begin*/,
                                  int /*end*/, const Real* /*V from column begin on*/,
                                  const Real* /*r*/) const {}
};

template <class ExecutionSpace, class Diffusion, class Model, class Recorder,
          int lag = tile_lag<ExecutionSpace>>
struct TiledStep {
  using Real = typename Diffusion::Scalar;
  using MemorySpace = typename ExecutionSpace::memory_space;
  using View = EnsembleField<Real, MemorySpace>;
  using Tiles = Tiling<ExecutionSpace, Diffusion, Model, lag>;
  using Pitch = typename Tiles::Pitch;
  using Tile = typename Tiles::Tile;
  using Rings = typename Tiles::Rings;
  using Policy = typename Tiles::Policy;
  using TeamMember = typename Policy::member_type;
  static constexpr bool on_host = Tiles::on_host;
  static constexpr int line = Tiles::line;
  using Columns = std::conditional_t<on_host, HostColumns<Real>, TeamColumns<TeamMember>>;

  Diffusion diffusion;
  Model model;
  Real dt;
  TileLayout layout;
  int row_tiles, column_tiles;
  Pitch pitch;
  ExcitationFields<View> old_state, new_state;
  int first_step;
  Recorder record;

  // Launches layout.passes times layout.depth steps, numbered from first_step on for
  // record(columns, m, i, step, begin, end, V, r), which sees the owned columns of row i before each step.
  // No fence. layout.columns is a multiple of a line's entries, or all columns, and no more than the widest
  // tile's; layout.depth is at most the deepest.
  static void launch(const ExecutionSpace& space, const Diffusion& diffusion, const Model& model, double dt,
                     const TileLayout& layout, const ExcitationFields<View>& old_state,
                     const ExcitationFields<View>& new_state, int first_step = 0,
                     const Recorder& record = {}) {
    const int members = static_cast<int>(old_state.V.extent(0));
    const int row_tiles = tiles_of(diffusion.grid.rows, layout.rows),
              column_tiles = tiles_of(diffusion.grid.columns, layout.columns);
    const Pitch pitch = Tiles::pitch_in(diffusion.grid, layout.columns, layout.depth);
    const TiledStep step{diffusion, model,     Real(dt),  layout,     row_tiles, column_tiles,
                         pitch,     old_state, new_state, first_step, record};
    Policy policy(space, members * row_tiles * column_tiles, Tiles::warps, Tiles::lanes);
    policy.set_scratch_size(Tiles::scratch_level,
                            Kokkos::PerTeam(Tiles::launch_bytes(diffusion.grid, layout)));
    Kokkos::parallel_for("myowave::tissue::tiled_step", policy, step);
  }

  // The rows in memory that a front is the first to read, and those that it writes. They are prefetched
  // during the front before, some columns with each of its levels: all at once would delay that front's own
  // rows, which come from the cache.
  struct RowsToCome {
    static constexpr int states = Model::has_tension ? 3 : 2;
    const Real* read[states + Diffusion::metric_arrays];
    const Real* written[states];
    KOKKOS_FORCEINLINE_FUNCTION void fetch(int begin, int end) const {
      for (int j = begin; j < end; j += line) {
        for (const Real* row : read) prefetch_to_read(row + j);
        for (const Real* row : written) prefetch_to_write(row + j);
      }
    }
  };

  // Source and destination of a pass.
  struct Pass {
    const ExcitationFields<View>&from, &to;
    int first_step;
  };

  KOKKOS_FUNCTION void operator()(const TeamMember& team) const {
    const Tile tile = tile_of(team.league_rank());
    const Columns columns = columns_of(team);
    const Rings rings = make_rings(team);
    const auto metric = diffusion.metric_rows(columns, tile.member, tile.origin, tile.width,
                                              rings.metric_begin, rings.slots, pitch);
    for (int n = 0; n < layout.passes; ++n) {
      const bool back = n % 2 == 1;
      go_up(team, tile, rings, metric,
            {back ? new_state : old_state, back ? old_state : new_state, first_step + n * layout.depth});
    }
  }

 private:
  template <class Metric>
  KOKKOS_FORCEINLINE_FUNCTION void go_up(const TeamMember& team, const Tile& tile, const Rings& rings,
                                         const Metric& metric, const Pass& pass) const {
    const int depth = layout.depth, rows = diffusion.grid.rows;
    const Columns columns = columns_of(team);
    const int first = Kokkos::max(0, tile.first_row - depth);
    const int top = Kokkos::min(rows, tile.last_row + depth);
    const int share = Tiles::round_up(tiles_of(tile.inside, depth));  // of the columns, to a level
    metric.begin(Kokkos::max(0, tile.first_row - depth + 1));
    for (int front = first; front < tile.last_row + lag * depth; ++front) {
      [[maybe_unused]] const RowsToCome next = rows_to_come(tile, pass, metric, front + 1);
      if (front < top) load(columns, tile, pass, rings, front);
      for (int n = 1; n <= depth; ++n) {
        const int level = opaque(n);
        if constexpr (on_host) next.fetch((level - 1) * share, Kokkos::min(level * share, tile.inside));
        const int i = front - lag * level, halo = depth - level;
        if (i < Kokkos::max(0, tile.first_row - halo) || i >= Kokkos::min(rows, tile.last_row + halo))
          continue;
        if (level == 1) metric.prepare(i);
        if (on_host && level > 1 && level < depth)
          advance<true>(columns, tile, pass, rings, metric, front, level);
        else
          advance<false>(columns, tile, pass, rings, metric, front, level);
      }
      team.team_barrier();
    }
  }

  KOKKOS_FORCEINLINE_FUNCTION static Columns columns_of([[maybe_unused]] const TeamMember& team) {
    if constexpr (on_host)
      return {};
    else
      return {team};
  }

  KOKKOS_FORCEINLINE_FUNCTION Tile tile_of(int rank) const {
    const int tiles = row_tiles * column_tiles, tile = rank % tiles, columns = diffusion.grid.columns;
    const int first_row = tile / column_tiles * layout.rows,
              first_column = tile % column_tiles * layout.columns;
    const int last_row = Kokkos::min(first_row + layout.rows, diffusion.grid.rows);
    const int last_column = Kokkos::min(first_column + layout.columns, columns);
    const int origin = Kokkos::max(0, first_column - layout.depth) / line * line;
    const int width = (Kokkos::min(last_column + layout.depth, columns) - origin + line - 1) / line * line;
    return {rank / tiles, first_row, last_row, first_column,
            last_column,  origin,    width,    Kokkos::min(width, columns - origin)};
  }

  template <class Metric>
  KOKKOS_FORCEINLINE_FUNCTION RowsToCome rows_to_come(const Tile& tile, const Pass& pass,
                                                      const Metric& metric, int front) const {
    const int m = tile.member, origin = tile.origin, top = diffusion.grid.rows - 1;
    const int loaded = Kokkos::min(front, top), first = Kokkos::clamp(front - lag, 0, top),
              last = Kokkos::clamp(front - lag * layout.depth, tile.first_row, tile.last_row - 1);
    RowsToCome rows{{&pass.from.V(m, loaded, origin), &pass.from.r(m, first, origin)},
                    {&pass.to.V(m, last, origin), &pass.to.r(m, last, origin)}};
    if constexpr (Model::has_tension) {
      rows.read[2] = &pass.from.Ta(m, first, origin);
      rows.written[2] = &pass.to.Ta(m, last, origin);
    }
    metric.rows_in_memory(first, rows.read + RowsToCome::states);
    return rows;
  }

  // Initialised to zero: results for entries outside the sheet and beside the computed columns are finite and
  // never used.
  KOKKOS_FORCEINLINE_FUNCTION Rings make_rings(const TeamMember& team) const {
    const int depth = layout.depth, slots = Tiles::slots_of(depth),
              entries = Tiles::scratch_entries(depth, pitch);
    constexpr int fast = Tiles::scratch_level;  // taken by reference, which a device can't of a static member
    auto* const scratch = static_cast<Real*>(
        team.team_scratch(fast).get_shmem_aligned(entries * sizeof(Real), detail::line_bytes));
    columns_of(team).each(0, entries, [=](int n) { scratch[n] = 0; });
    team.team_barrier();
    Real* const V = scratch + line;
    Real* const r = V + Tiles::V_fronts * array_entries<Real>(depth, pitch);
    return {V, r, r + Tiles::state_arrays * array_entries<Real>(slots, pitch), depth, slots, pitch};
  }

  // Sets the neighbours outside the sheet in a scratch row: V(-1) = V(1), V(n) = V(n - 2).
  KOKKOS_FORCEINLINE_FUNCTION void mirror_ends(const Columns& columns, const Tile& tile, Real* V) const {
    if constexpr (!Diffusion::mirrors) return;
    const int right = diffusion.grid.columns - tile.origin;
    if (tile.origin > 0 && right > tile.width) return;
    columns.wait();
    columns.once([=]() {
      if (tile.origin == 0) V[-1] = V[1];
      if (right <= tile.width) V[right] = V[right - 2];
    });
  }

  KOKKOS_FORCEINLINE_FUNCTION void load(const Columns& columns, const Tile& tile, const Pass& pass,
                                        const Rings& rings, int i) const {
    Real* const V = rings.V(i, 0);
    const Real* const from = &pass.from.V(tile.member, i, tile.origin);
    columns.each_again(0, tile.inside, [=](int j) { V[j] = from[j]; });
    mirror_ends(columns, tile, V);
  }

  // Most levels read and write scratch rows only. A template parameter says so, because on a host's short
  // rows the decisions before the loop count.
  template <bool between_scratch_rows, class Metric>
  KOKKOS_FORCEINLINE_FUNCTION void advance(const Columns& columns, const Tile& tile, const Pass& pass,
                                           const Rings& rings, const Metric& metric, int front,
                                           int level) const {
    const int m = tile.member, origin = tile.origin, i = front - lag * level;
    const int owned = tile.first_column - origin;
    const Real* below = rings.V(front - lag - 1, level - 1);
    const Real* const here = rings.V(front - lag, level - 1);
    const Real* above = rings.V(front - lag + 1, level - 1);
    if constexpr (Diffusion::mirrors) {
      if (i == 0) below = above;
      if (i == diffusion.grid.rows - 1) above = below;
    }
    const auto row = metric.row({below, here, above}, i);
    const bool first = !between_scratch_rows && level == 1,
               last = !between_scratch_rows && level == layout.depth;
    const NodeUpdate<Model> update{model,
                                   dt,
                                   here,
                                   first ? &pass.from.r(m, i, origin) : rings.r(i),
                                   tension(first, pass.from.Ta, rings, m, i, origin),
                                   last ? &pass.to.V(m, i, origin) : rings.V(front, level),
                                   last ? &pass.to.r(m, i, origin) : rings.r(i),
                                   tension(last, pass.to.Ta, rings, m, i, origin)};
    if (i >= tile.first_row && i < tile.last_row)
      record(columns, m, i, pass.first_step + level - 1, tile.first_column, tile.last_column, here + owned,
             update.r + owned);
    const AdvanceColumn<std::decay_t<decltype(row)>> at{update, row};
    if (last)
      columns.each_again(owned, tile.last_column - origin, at);
    else if (first)
      columns.each_again(0, tile.inside, at);
    else
      columns.each_of_whole_lines(tile.width, at);
    if (!last) mirror_ends(columns, tile, update.V_next);
  }

  // By reference: a copy of so many pointers would go through the stack at each level.
  template <class Row>
  struct AdvanceColumn {
    const NodeUpdate<Model>& update;
    const Row& row;
    KOKKOS_FORCEINLINE_FUNCTION void operator()(int j) const { update(j, row(j - 1, j, j + 1)); }
  };

  KOKKOS_FORCEINLINE_FUNCTION static Real* tension(bool in_memory, const View& Ta, const Rings& rings, int m,
                                                   int i, int origin) {
    if constexpr (!Model::has_tension)
      return nullptr;
    else
      return in_memory ? &Ta(m, i, origin) : rings.Ta(i);
  }
};

// Any number of steps without a stimulus, in passes whose depths differ by one at most. The new state is in
// `state` afterwards; `spare` are fields of the same shape.
template <class ExecutionSpace, class Diffusion, class Model, class View, class Recorder = NoRecorder>
void tiled_steps(const ExecutionSpace& space, const Diffusion& diffusion, const Model& model, double dt,
                 int steps, ExcitationFields<View>& state, ExcitationFields<View>& spare, int first_step = 0,
                 const Recorder& record = {}) {
  using Step = TiledStep<ExecutionSpace, Diffusion, Model, Recorder>;
  using Tiles = typename Step::Tiles;
  const int members = static_cast<int>(state.V.extent(0));
  const int passes = Tiles::choose_passes(space, diffusion.grid, members, steps);
  for (int n = 0, done = 0; n < passes;) {
    const int depth = (steps - done) / (passes - n);
    TileLayout layout = Tiles::choose_tiles(space, diffusion.grid, members, depth);
    const bool whole_sheets = layout.rows == diffusion.grid.rows && layout.columns == diffusion.grid.columns;
    const int deeper = (steps - done) % (passes - n);  // passes left that are one step deeper
    if (whole_sheets) layout.passes = passes - n - deeper;
    Step::launch(space, diffusion, model, dt, layout, state, spare, first_step + done, record);
    if (layout.passes % 2 == 1) std::swap(state, spare);
    n += layout.passes;
    done += layout.passes * layout.depth;
  }
}

}  // namespace myowave::tissue
