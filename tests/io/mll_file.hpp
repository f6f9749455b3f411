// Writes CGNS files with the mid-level library, as most programs that users have do.
#pragma once

#include <cgnslib.h>

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

namespace gridmorph::test {

class MllFile {
 public:
  MllFile(std::string const& path, int cell_dimension = 3, int physical_dimension = 3) {
    check(cg_set_file_type(CG_FILE_HDF5));
    check(cg_open(path.c_str(), CG_MODE_WRITE, &file_));
    check(cg_base_write(file_, "Base", cell_dimension, physical_dimension, &base_));
  }
  ~MllFile() {
    if (file_ != 0) cg_close(file_);
  }
  MllFile(MllFile const&) = delete;
  MllFile& operator=(MllFile const&) = delete;
  void close() {
    check(cg_close(file_));
    file_ = 0;
  }

  static void check(int status) {
    if (status != CG_OK) throw std::runtime_error(cg_get_error());
  }

  /// A box of unit cells with its first node at `origin`; returns the zone's number.
  int box(std::string const& name, std::array<int, 3> n, std::array<double, 3> origin = {0, 0, 0},
          std::vector<char const*> const& coordinate_names = {"CoordinateX", "CoordinateY", "CoordinateZ"}) {
    cgsize_t size[9] = {};
    for (int a = 0; a < 3; ++a) {
      size[a] = n[a];
      size[3 + a] = n[a] - 1;
    }
    int zone = 0;
    check(cg_zone_write(file_, base_, name.c_str(), size, CGNS_ENUMV(Structured), &zone));
    for (int c = 0; c < 3; ++c) {
      std::vector<double> x;
      for (int k = 0; k < n[2]; ++k)
        for (int j = 0; j < n[1]; ++j)
          for (int i = 0; i < n[0]; ++i) x.push_back(origin[c] + std::array{i, j, k}[c]);
      int number = 0;
      check(cg_coord_write(file_, base_, zone, CGNS_ENUMV(RealDouble), coordinate_names[c], x.data(), &number));
    }
    return zone;
  }

  int bc(int zone, std::string const& name, CGNS_ENUMT(BCType_t) type, CGNS_ENUMT(PointSetType_t) set,
         std::vector<cgsize_t> const& points, CGNS_ENUMT(GridLocation_t) location = CGNS_ENUMV(Vertex),
         int dimension = 3) {
    int number = 0;
    check(cg_boco_write(file_, base_, zone, name.c_str(), type, set, cgsize_t(points.size()) / dimension, points.data(),
                        &number));
    if (location != CGNS_ENUMV(Vertex)) check(cg_boco_gridlocation_write(file_, base_, zone, number, location));
    return number;
  }

  int one_to_one(int zone, std::string const& name, std::string const& donor, std::array<cgsize_t, 6> range,
                 std::array<cgsize_t, 6> donor_range, std::array<int, 3> transform) {
    int number = 0;
    check(cg_1to1_write(file_, base_, zone, name.c_str(), donor.c_str(), range.data(), donor_range.data(),
                        transform.data(), &number));
    return number;
  }

  [[nodiscard]] int file() const { return file_; }
  [[nodiscard]] int base() const { return base_; }

 private:
  int file_ = 0;
  int base_ = 0;
};

}  // namespace gridmorph::test
