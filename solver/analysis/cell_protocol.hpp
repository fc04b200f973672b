// A single cell of the model, without tissue, under a stimulus protocol: V_t = (f(V, r) + I_s) / C_m and the
// pointwise equations of r and Ta (kernels/cell), explicit Euler, all from the old state.
#pragma once

#include <vector>

#include "solver/analysis/rhythm.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::solver {

struct CellState {
  double V = 0, r = 0;
  double Ta = 0;  // kPa
};

// A cell and the pulses that pace it. The default ones are short and lift V at rest to 0.5.
struct PacedCell {
  ExcitationSettings excitation;  // D is not used
  TensionSettings tension;        // law `none`: Ta stays as it is
  double dt = 0.02;               // t.u.; the paper's
  double amplitude = 2.5;         // I_s, 1/t.u.
  double duration = 0.2;          // t.u., of a pulse
};

// Aliev and Panfilov's own set (Chaos, Solitons & Fractals 7, 1996), as in the paper's Fig 1: a = b = 0.15,
// eps = 0.002, mu1 = 0.2, k = 8, mu2 = 0.3, dt = 0.001. They take 1 t.u. for 12.9 ms.
PacedCell aliev_panfilov_cell();
inline constexpr double aliev_panfilov_ms_per_tu = 12.9;

// Time (t.u.) from a state until V falls through `level`, by linear interpolation, without stimulus.
// Errors: NumericalFailure if V is above the level after 10000 t.u.
double time_to_fall(const PacedCell&, const CellState&, double level);

// The course of a cell; all vectors except beats have the same length.
struct CellCourse {
  std::vector<double> t;  // t.u., since the first pulse
  std::vector<double> V, r;
  std::vector<double> Ta;   // kPa
  std::vector<Beat> beats;  // the last one without period
};

// From rest, a pulse at 0, cycle_length, ... (t.u., taken as the nearest number of steps), `pulses` of them.
// The course at 0 and every `sample_every` t.u. to the end of the last cycle.
// Errors: InputError if a length is shorter than a step, or a pulse longer than the cycle.
CellCourse pace_cell(const PacedCell&, double cycle_length, int pulses, double sample_every);

// The dynamic restitution protocol: `pulses` at the longest cycle length from rest, then at each shorter one,
// without a reset in between.
struct RestitutionProtocol {
  PacedCell cell;
  double longest = 60, shortest = 30;  // cycle lengths, t.u.
  double step = 1;                     // t.u.
  int pulses = 60;                     // a cycle length
  int kept = 8;                        // the last pulses of each, which are evaluated
  double alternans = 0.2;              // t.u.: APDs of successive beats that differ by more alternate
};

// Responses to the last pulses at a cycle length.
struct RestitutionPoint {
  enum class Capture { one_to_one, two_to_one, other };
  double cycle_length = 0;  // t.u.
  std::vector<Beat> beats;  // action potentials after the kept pulses; di and period if there was a next one
  Capture capture = Capture::other;
  bool alternates = false;  // one to one, with alternating long and short APDs

  // Means over the beats, t.u.; nan if there is none.
  double apd() const;  // V > 0.1
  double apd90() const;
  double di() const;
};

// From the longest cycle length to the shortest.
// Errors: InputError as pace_cell, or if the cycle lengths do not step down.
std::vector<RestitutionPoint> restitution(const RestitutionProtocol&);

}  // namespace myowave::solver
