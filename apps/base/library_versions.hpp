// Versions of the libraries that the program was compiled with.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace myowave::apps {

// Of a version coded as a number, MAJOR major + MINOR minor + patch: "MAJOR.MINOR.PATCH".
std::string dotted(int code, int major, int minor);

// By name; all but Kokkos, whose headers are for what is compiled for a device.
nlohmann::ordered_json library_versions();

}  // namespace myowave::apps
