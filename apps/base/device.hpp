#pragma once

#include <Kokkos_Core.hpp>

namespace myowave::apps {

// Kokkos for one command. Its warnings about thread binding are off: the command binds no threads.
class Device {
 public:
  Device() {
    if (!Kokkos::is_initialized()) {
      Kokkos::initialize(Kokkos::InitializationSettings().set_disable_warnings(true));
      owned_ = true;
    }
  }
  ~Device() {
    if (owned_) Kokkos::finalize();
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

 private:
  bool owned_ = false;
};

}  // namespace myowave::apps
