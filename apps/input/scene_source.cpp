#include "apps/input/scene_source.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "apps/input/scene_file.hpp"
#include "apps/input/toml_input.hpp"
#include "solver/base/error.hpp"

namespace myowave::apps {

solver::Scene SceneSource::scene() const { return parse_scene(text, file, overrides); }

std::string SceneSource::json() const {
  // The one path that an override can have.
  constexpr std::string_view state_file = "initial.file=";
  std::vector<std::string> anywhere = overrides;
  for (auto& one : anywhere)
    if (one.starts_with(state_file))
      one = std::string(state_file) + std::filesystem::absolute(one.substr(state_file.size())).string();
  const nlohmann::json source{
      {"file", std::filesystem::absolute(file).string()}, {"text", text}, {"overrides", anywhere}};
  return source.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

SceneSource read_source(const std::string& file, std::vector<std::string> overrides) {
  return {file, toml_text(file, "scene"), std::move(overrides)};
}

SceneSource source_from(const std::string& json) {
  try {
    const auto source = nlohmann::json::parse(json);
    return {source.at("file").get<std::string>(), source.at("text").get<std::string>(),
            source.at("overrides").get<std::vector<std::string>>()};
  } catch (const nlohmann::json::exception& error) {
    throw solver::InputError(fmt::format("the checkpoint tells no scene: {}", error.what()));
  }
}

}  // namespace myowave::apps
