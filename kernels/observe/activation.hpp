// When each node is activated: V is sampled at intervals, and its crossings are collected in a record per
// node, on the device for the whole run. Crossings are interpolated linearly between two samples:
//   t(level) = t0 + (t1 - t0) (level - V0) / (V1 - V0)
// A sample reads V and a mark of each node; records are accessed only where a beat starts or ends, which is
// rare.
//
//   view      shape                      unit   access
//   V         (members, rows, columns)   -      read
//   marks     (members, rows, columns)   -      read and write, of the last sample
//   records   (members, rows, columns)   t.u.   read and write
#pragma once

#include <cstdint>

#include "kernels/base/views.hpp"

namespace myowave::observe {

// The levels of V; those of solver/analysis/rhythm.hpp.
struct ActivationLevels {
  float upstroke = 0.5F;  // activation
  float rearm = 0.2F;     // V has to fall below it before the next activation
  float end = 0.1F;       // an action potential lasts until V falls through it
};

// What is known of a node, times in t.u.
struct ActivationRecord {
  double first = 0, last = 0;     // activations, where there are any
  double mean_period = 0;         // from one activation to the next, running mean and, about it,
  double squared_deviations = 0;  //   the sum of squares (Welford)
  double total_apd = 0;           // from activation to end
  int beats = 0;                  // activations
  int periods = 0, apds = 0;      // number of those in the mean and in the total
  int active = 0;                 // the last action potential has not ended
};

// A mark is V of the last sample, in float32: 6e-8 is all that the interpolation needs. Of a node that is not
// armed this much is added; V is then far above `rearm`, or falls through both levels within one interval.
inline constexpr float not_armed = 1024.0F;

// Two consecutive samples. Without branches up to update(), so that SIMD lanes process a row.
struct ActivationInterval {
  double t_before, t;  // t.u.
  double from;         // t.u.: periods and APDs of beats with an earlier activation do not count
  ActivationLevels levels;

  static KOKKOS_FORCEINLINE_FUNCTION float V_of(float mark) {
    return mark < 0.5F * not_armed ? mark : mark - not_armed;
  }
  KOKKOS_FORCEINLINE_FUNCTION int activates(float mark, float V) const {
    return int(mark < levels.upstroke) & int(V >= levels.upstroke);
  }
  KOKKOS_FORCEINLINE_FUNCTION int ends(float mark, float V) const {
    return int(mark >= levels.end) & int(V < levels.end);  // a mark is never below V
  }
  KOKKOS_FORCEINLINE_FUNCTION float next_mark(float mark, float V) const {
    const int stays =
        int(mark < 0.5F * not_armed) & (int(mark >= levels.upstroke) | int(V < levels.upstroke));
    const int armed = stays | int(V < levels.rearm);
    return V + static_cast<float>(1 - armed) * not_armed;
  }

  KOKKOS_INLINE_FUNCTION void update(float mark, float V, ActivationRecord& record) const {
    if (activates(mark, V) != 0) begin(crossing(mark, V, levels.upstroke), record);
    if (ends(mark, V) != 0 && record.active != 0) {
      record.active = 0;
      if (record.last < from) return;
      record.total_apd += crossing(mark, V, levels.end) - record.last;
      ++record.apds;
    }
  }

 private:
  KOKKOS_INLINE_FUNCTION double crossing(float mark, float V, float level) const {
    return t_before + (t - t_before) * double((level - V_of(mark)) / (V - V_of(mark)));
  }

  KOKKOS_INLINE_FUNCTION void begin(double activation, ActivationRecord& record) const {
    if (record.beats == 0) record.first = activation;
    if (record.beats > 0 && record.last >= from) {
      const double period = activation - record.last, deviation = period - record.mean_period;
      ++record.periods;
      record.mean_period += deviation / record.periods;
      record.squared_deviations += deviation * (period - record.mean_period);
    }
    record.last = activation;
    record.active = 1;
    ++record.beats;
  }
};

template <class MemorySpace>
struct ActivationFields {
  using Marks = EnsembleField<float, MemorySpace>;
  using Records = EnsembleField<ActivationRecord, MemorySpace>;
  Marks marks;
  Records records;
};

// The first sample of V, of all members: starts new records.
template <class ExecutionSpace, class View>
void begin_activation(const ExecutionSpace& space, const View& V,
                      const ActivationFields<typename View::memory_space>& fields,
                      const ActivationLevels& levels = {}) {
  const int rows = static_cast<int>(V.extent(1)), columns = static_cast<int>(V.extent(2));
  Kokkos::parallel_for(
      "myowave::observe::begin_activation",
      Kokkos::RangePolicy<ExecutionSpace>(space, 0, static_cast<int>(V.extent(0)) * rows),
      KOKKOS_LAMBDA(int row) {
        const int m = row / rows, i = row % rows;
        for (int j = 0; j < columns; ++j) {
          const auto now = static_cast<float>(V(m, i, j));
          fields.marks(m, i, j) = now < levels.rearm ? now : now + not_armed;
          fields.records(m, i, j) = {};
        }
      });
}

// Nodes are processed in blocks of as many columns as a mask has bits.
inline constexpr int activation_block = 32;

// Bit j: the record of column j has to be updated.
template <class Real>
KOKKOS_INLINE_FUNCTION std::uint32_t nodes_to_update(const ActivationInterval& interval, const Real* V,
                                                     const float* marks, int columns) {
  std::uint32_t changed = 0;
#pragma omp simd reduction(| : changed)
  for (int j = 0; j < columns; ++j) {
    const auto now = static_cast<float>(V[j]);
    changed |= static_cast<std::uint32_t>(interval.activates(marks[j], now) | interval.ends(marks[j], now))
               << j;
  }
  return changed;
}

// `interval` by value: a mark that is stored could alias the levels, and no SIMD lane would take them.
template <class Real>
KOKKOS_INLINE_FUNCTION void refresh_marks(ActivationInterval interval, const Real* V, float* marks,
                                          int columns) {
#pragma omp simd
  for (int j = 0; j < columns; ++j) marks[j] = interval.next_mark(marks[j], static_cast<float>(V[j]));
}

// The next sample of V, of all members.
template <class ExecutionSpace, class View>
void sample_activation(const ExecutionSpace& space, const View& V, const ActivationInterval& interval,
                       const ActivationFields<typename View::memory_space>& fields) {
  const int rows = static_cast<int>(V.extent(1)), columns = static_cast<int>(V.extent(2));
  Kokkos::parallel_for(
      "myowave::observe::sample_activation",
      Kokkos::RangePolicy<ExecutionSpace>(space, 0, static_cast<int>(V.extent(0)) * rows),
      KOKKOS_LAMBDA(int row) {
        const int m = row / rows, i = row % rows;
        for (int first = 0; first < columns; first += activation_block) {
          const int size = columns - first < activation_block ? columns - first : activation_block;
          const auto* const now = &V(m, i, first);
          float* const marks = &fields.marks(m, i, first);
          for (auto changed = nodes_to_update(interval, now, marks, size); changed != 0;
               changed &= changed - 1) {
            const int j = Kokkos::countr_zero(changed);
            interval.update(marks[j], static_cast<float>(now[j]), fields.records(m, i, first + j));
          }
          refresh_marks(interval, now, marks, size);
        }
      });
}

}  // namespace myowave::observe
