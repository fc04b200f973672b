// Parameters of the cell model and of the active tension, without device functions: scenes hold the same
// structs, and what reads scenes compiles without Kokkos. Defaults: Table 1 of Nash & Panfilov 2004.
#pragma once

namespace myowave::cell {

// Eqs 22a, b. Table 1 omits b; 0.1 gives the paper's periods and its turbulence.
template <class Real>
struct AlievPanfilovParameters {
  Real k = Real(8);       // 1/t.u., rate of the fast current, >= 0
  Real a = Real(0.1);     // excitation threshold, 0 to 1
  Real b = Real(0.1);     // shape of the recovery equation
  Real eps = Real(0.01);  // 1/t.u., recovery rate at rest, >= 0
  Real mu1 = Real(0.12);  // 1/t.u., recovery rate in activity, >= 0
  Real mu2 = Real(0.3);   // V at which that rate halves, > 0

  template <class Other>
  constexpr AlievPanfilovParameters<Other> cast() const {
    return {Other(k), Other(a), Other(b), Other(eps), Other(mu1), Other(mu2)};
  }
};

// Eqs 22c, 23. The rates are those of the law "delayed", with which tension lags V as in the paper's Fig 2a.
template <class Real>
struct ActiveTensionParameters {
  Real k_Ta = Real(47.9);       // kPa, tension at V = 1, >= 0
  Real eps_below = Real(1);     // 1/t.u., rate where V < threshold, >= 0
  Real eps_above = Real(0.1);   // 1/t.u., rate from there on, >= 0
  Real threshold = Real(0.05);  // V

  template <class Other>
  constexpr ActiveTensionParameters<Other> cast() const {
    return {Other(k_Ta), Other(eps_below), Other(eps_above), Other(threshold)};
  }
};

}  // namespace myowave::cell
