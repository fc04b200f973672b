// maps.h5: activation, period, APD and conduction velocity of each node; its datasets are a contract
// (apps/results/README.md).
#pragma once

#include <filesystem>

#include "solver/base/activation_maps.hpp"

namespace myowave::apps {

// Errors: std::runtime_error "cannot write FILE: reason".
void write_maps(const std::filesystem::path&, const solver::ActivationMaps&);

}  // namespace myowave::apps
