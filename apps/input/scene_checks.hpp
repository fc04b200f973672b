// What several keys of a scene must agree on, and the values that follow from others.
#pragma once

#include <string>

#include "apps/input/scene_reader.hpp"

namespace myowave::apps {

// Adds what is wrong to the scene's problems and completes it: default probes and intervals of outputs, the
// step of a preset, the sheet on the run's spacing.
void check_scene(ReadScene&);

// Those of [initial].
void check_initial(ReadScene&);

// "columns 0 to 250, rows 0 to 250".
std::string sheet_text(const solver::GridSettings&);

// Of a spacing that the key at the path gives: false, and reported, where a side has more nodes than can be
// counted.
bool check_node_count(ReadScene&, const std::string& path, double given, double spacing);

}  // namespace myowave::apps
