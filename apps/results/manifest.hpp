// manifest.json: what is needed to repeat a run: configuration, program, machine, versions.
#pragma once

#include <nlohmann/json.hpp>

namespace myowave::apps {

nlohmann::ordered_json manifest_json(const nlohmann::json& effective_configuration);

}  // namespace myowave::apps
