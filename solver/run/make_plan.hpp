// Makes the plan of a scene, from the same predicates (solver/scene/scene.hpp) that the run uses.
#pragma once

#include <cstdint>
#include <vector>

#include "solver/base/plan.hpp"
#include "solver/scene/scene.hpp"

namespace myowave::solver {

// Uses 64-bit arithmetic and allocates nothing, so that sheets larger than any memory have a plan too.
Plan make_plan(const Scene&);
inline std::uint64_t memory_bytes(const Scene& scene) { return make_plan(scene).bytes(); }

// Views by memory space: first the space of the excitation, then the host's if that is another.
// solver/run/memory_watch.hpp measures the same.
std::vector<SpaceBytes> views_of(const Plan&);

// Whether the excitation runs in a memory of its own, apart from the host's.
bool has_device_memory();

}  // namespace myowave::solver
