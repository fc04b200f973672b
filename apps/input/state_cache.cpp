#include "apps/input/state_cache.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <optional>

#include "apps/base/content_hash.hpp"
#include "apps/base/hdf5_handle.hpp"

namespace myowave::apps {
namespace {

// Changes when the files' layout does, so that older ones are left aside.
constexpr int format_version = 1;

std::filesystem::path cache_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  // The XDG specification tells to ignore a relative path.
  if (cache != nullptr && std::filesystem::path(cache).is_absolute())
    return std::filesystem::path(cache) / "myowave";
  const char* home = std::getenv("HOME");
  if (home == nullptr || *home == '\0') return {};
  return std::filesystem::path(home) / ".cache" / "myowave";
}

void write_dataset(hid_t file, const char* name, const solver::InitialState& state,
                   const std::vector<double>& values) {
  const std::array<hsize_t, 2> size{hsize_t(state.rows), hsize_t(state.columns)};
  const Hdf5Handle space(H5Screate_simple(2, size.data(), nullptr), H5Sclose, name);
  const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, name);
  check_hdf5(H5Pset_chunk(creation, 2, size.data()), name);
  // A checksum, so that a damaged file is found when it is read.
  check_hdf5(H5Pset_fletcher32(creation), name);
  const Hdf5Handle dataset(H5Dcreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                           H5Dclose, name);
  check_hdf5(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name);
}

void write_state(const std::filesystem::path& path, const std::string& definition,
                 const solver::InitialState& state) {
  start_hdf5();
  const Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose,
                        path.string());
  write_attribute(file, "definition", definition);
  write_dataset(file, "V", state, state.V);
  write_dataset(file, "r", state, state.r);
  write_dataset(file, "Ta", state, state.Ta);
  check_hdf5(H5Fflush(file, H5F_SCOPE_GLOBAL), path.string());
}

std::string read_definition(hid_t file) {
  const char* name = "definition";
  const Hdf5Handle attribute(H5Aopen(file, name, H5P_DEFAULT), H5Aclose, name);
  const Hdf5Handle type(H5Aget_type(attribute), H5Tclose, name);
  char* characters = nullptr;
  check_hdf5(H5Aread(attribute, type, static_cast<void*>(&characters)), name);
  const std::string text = characters;
  H5free_memory(characters);
  return text;
}

std::vector<double> read_dataset(hid_t file, const char* name, std::array<hsize_t, 2>& size) {
  const Hdf5Handle dataset(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose, name);
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose, name);
  if (H5Sget_simple_extent_ndims(space) != 2) throw Hdf5Error(std::string(name) + ": not [row, column]");
  H5Sget_simple_extent_dims(space, size.data(), nullptr);
  std::vector<double> values(size[0] * size[1]);
  check_hdf5(H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name);
  return values;
}

}  // namespace

std::optional<solver::InitialState> find_state(const std::filesystem::path& path,
                                               const std::string& definition) {
  if (!std::filesystem::exists(path)) return std::nullopt;
  try {
    start_hdf5();
    const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, path.string());
    if (read_definition(file) != definition) return std::nullopt;
    std::array<hsize_t, 2> V{}, r{}, Ta{};
    solver::InitialState state;
    state.V = read_dataset(file, "V", V);
    state.r = read_dataset(file, "r", r);
    state.Ta = read_dataset(file, "Ta", Ta);
    if (V != r || V != Ta) return std::nullopt;
    state.rows = int(V[0]);
    state.columns = int(V[1]);
    return state;
  } catch (const Hdf5Error&) {
    return std::nullopt;
  }
}

void keep_state(const std::filesystem::path& path, const std::string& definition,
                const solver::InitialState& state) {
  std::filesystem::path temporary = path;
  temporary += fmt::format(".{}.tmp", getpid());
  try {
    std::filesystem::create_directories(path.parent_path());
    write_state(temporary, definition, state);
    std::filesystem::rename(temporary, path);
  } catch (const std::runtime_error& error) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw std::runtime_error(fmt::format("cannot write {}: {}", path.string(), error.what()));
  }
}

std::filesystem::path cached_state_path(const std::string& name, const std::string& definition) {
  const auto folder = cache_folder();
  if (folder.empty()) return {};
  const std::string hash = content_hash(fmt::format("format {}\n{}", format_version, definition));
  return folder / fmt::format("{}_{}.h5", name, hash);
}

solver::InitialState cached_state(const std::filesystem::path& path, const std::string& definition,
                                  const std::function<solver::InitialState()>& compute) {
  if (path.empty()) return compute();
  if (auto found = find_state(path, definition)) return *std::move(found);

  solver::InitialState state = compute();
  try {
    keep_state(path, definition, state);
  } catch (const std::runtime_error& error) {
    fmt::print(stderr, "myowave: the state could not be kept in the cache ({}); it will be computed again\n",
               error.what());
  }
  return state;
}

}  // namespace myowave::apps
