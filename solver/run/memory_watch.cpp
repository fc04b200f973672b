#include "solver/run/memory_watch.hpp"

#include <Kokkos_Core.hpp>
#include <algorithm>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

namespace myowave::solver {
namespace {

struct Account {
  struct Bytes {
    std::uint64_t now = 0, most = 0;
  };
  Kokkos::Tools::Experimental::EventSet tool;  // the callbacks that are set without the watch
  std::map<std::string, Bytes> spaces;
  std::unordered_map<const void*, std::uint64_t> sizes;
};

// Global, because Kokkos' callbacks are plain functions.
std::mutex account_mutex;
std::optional<Account> account;

void add(Kokkos::Tools::SpaceHandle space, const char* label, const void* data, std::uint64_t size) {
  const std::lock_guard lock(account_mutex);
  if (account->tool.allocate_data != nullptr) account->tool.allocate_data(space, label, data, size);
  if (!std::string_view(label).starts_with("myowave::")) return;
  account->sizes[data] = size;
  Account::Bytes& bytes = account->spaces[space.name];
  bytes.now += size;
  bytes.most = std::max(bytes.most, bytes.now);
}

void remove(Kokkos::Tools::SpaceHandle space, const char* label, const void* data, std::uint64_t size) {
  const std::lock_guard lock(account_mutex);
  if (account->tool.deallocate_data != nullptr) account->tool.deallocate_data(space, label, data, size);
  const auto found = account->sizes.find(data);
  if (found == account->sizes.end()) return;  // allocated before the watch, or not by the project
  account->spaces[space.name].now -= found->second;
  account->sizes.erase(found);
}

}  // namespace

MemoryWatch::MemoryWatch() {
  account.emplace().tool = Kokkos::Tools::Experimental::get_callbacks();
  Kokkos::Tools::Experimental::set_allocate_data_callback(add);
  Kokkos::Tools::Experimental::set_deallocate_data_callback(remove);
}

MemoryWatch::~MemoryWatch() {
  Kokkos::Tools::Experimental::set_allocate_data_callback(account->tool.allocate_data);
  Kokkos::Tools::Experimental::set_deallocate_data_callback(account->tool.deallocate_data);
  account.reset();
}

std::vector<SpaceBytes> MemoryWatch::most() const {
  const std::lock_guard lock(account_mutex);
  std::vector<SpaceBytes> spaces;
  for (const auto& [name, bytes] : account->spaces) spaces.push_back({name, bytes.most});
  return spaces;
}

}  // namespace myowave::solver
