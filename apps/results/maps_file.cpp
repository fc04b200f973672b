#include "apps/results/maps_file.hpp"

#include <array>
#include <string>

#include "apps/base/hdf5_handle.hpp"
#include "apps/base/revision.hpp"

namespace myowave::apps {

void write_maps(const std::filesystem::path& path, const solver::ActivationMaps& maps) {
  const std::string what = "cannot write " + path.string();
  start_hdf5();
  const Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose, what);
  write_attribute(file, "program", std::string("myowave ") + version());
  write_attribute(file, "dx", maps.dx);
  const std::array<hsize_t, 2> shape{hsize_t(maps.rows), hsize_t(maps.columns)};
  const Hdf5Handle space(H5Screate_simple(2, shape.data(), nullptr), H5Sclose, what);

  const auto write = [&](const char* name, const auto& values, hid_t file_type, hid_t type, const char* unit,
                         const char* description) {
    Hdf5Handle dataset(H5Dcreate2(file, name, file_type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                       H5Dclose, what);
    check_hdf5(H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), what);
    write_attribute(dataset, "units", std::string(unit));
    write_attribute(dataset, "long_name", std::string(description));
    return dataset;
  };
  const auto write_numbers = [&](const char* name, const std::vector<double>& values, const char* unit,
                                 const char* description) {
    return write(name, values, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, unit, description);
  };
  write_numbers("activation", maps.activation, "t.u.", "last time that V rose through 0.5");
  write_numbers("first_activation", maps.first_activation, "t.u.", "first time that V rose through 0.5");
  write_numbers("period", maps.period, "t.u.", "mean time from one activation to the next");
  write_numbers("period_sd", maps.period_sd, "t.u.", "its standard deviation");
  const Hdf5Handle apd =
      write_numbers("apd", maps.apd, "t.u.", "mean time from activation until V falls through level");
  write_attribute(apd, "level", maps.apd_level);
  write("beats", maps.beats, H5T_STD_I32LE, H5T_NATIVE_INT, "1", "activations in the whole run");
  write_numbers("conduction_velocity", maps.conduction_velocity, "length units / t.u.",
                "1 / |grad activation| on the undeformed sheet");
  check_hdf5(H5Fflush(file, H5F_SCOPE_GLOBAL), what);
}

}  // namespace myowave::apps
