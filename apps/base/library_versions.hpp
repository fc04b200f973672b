// Versions of the libraries that the program was compiled with.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace myowave::apps {

// Of a version coded as a number, MAJOR major + MINOR minor + patch: "MAJOR.MINOR.PATCH".
std::string dotted(int code, int major, int minor);

// By name. Without Kokkos, because its headers need a device compiler.
nlohmann::ordered_json library_versions();

}  // namespace myowave::apps
