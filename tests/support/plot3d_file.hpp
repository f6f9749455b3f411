// PLOT3D files written from a mesh with none of the code under test.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>

namespace gridmorph::test {

/// How a file is to be stored. 2-D: the plane k = 0 of every zone, x and y.
struct Plot3dStorage {
  char kind = 'u';  ///< formatted, unformatted, binary
  int marker = 4;
  bool big = false, wide = true, multi = true, blank = false;
  int dimensions = 3;
  bool planes = false;     ///< a record per plane k
  int longest_record = 0;  ///< bytes after which Fortran records are split; 0: never
  char const* number = "%.16e";

  [[nodiscard]] std::string name() const {
    std::string text = kind == 'f' ? "formatted" : kind == 'u' ? "unformatted" : "binary";
    if (kind != 'f') text += std::string(big ? "_big" : "_little") + (wide ? "_double" : "_single");
    if (marker == 8) text += "_marker8";
    if (longest_record > 0) text += "_split";
    return text + (multi ? "_multi" : "_one") + (dimensions == 2 ? "_2d" : "_3d") + (blank ? "_iblank" : "") +
           (planes ? "_planes" : "");
  }
};

class Plot3dFile {
 public:
  explicit Plot3dFile(Plot3dStorage storage) : s_(storage) {}

  std::string bytes(Mesh const& mesh) {
    out_.clear();
    if (s_.multi) {
      integer(int(mesh.zones.size()));
      close_record();
    }
    for (auto const& zone : mesh.zones)
      for (int a = 0; a < s_.dimensions; ++a) integer(zone.extent[a]);
    close_record();
    for (auto const& zone : mesh.zones) {
      Coordinates const& x = mesh.coordinates;
      int const nk = s_.dimensions == 2 ? 1 : zone.extent[2];
      int from = 0, to = nk;
      auto const each = [&](auto const& visit) {
        for (int k = from; k < to; ++k)
          for (int j = 0; j < zone.extent[1]; ++j)
            for (int i = 0; i < zone.extent[0]; ++i) visit(zone.node({i, j, k}));
      };
      for (; from < nk; from = to) {
        to = s_.planes ? from + 1 : nk;
        each([&](Index n) { real(x.x(n)); });
        each([&](Index n) { real(x.y(n)); });
        if (s_.dimensions == 3) each([&](Index n) { real(x.z(n)); });
        if (s_.blank) each([&](Index n) { integer(int(n % 3) - 1); });
        close_record();
      }
    }
    return out_;
  }

 private:
  template <class T>
  void raw(T value, std::string& to) {
    char b[sizeof(T)];
    std::memcpy(b, &value, sizeof(T));
    if (s_.big) std::reverse(b, b + sizeof(T));
    to.append(b, sizeof(T));
  }
  void integer(int value) {
    if (s_.kind == 'f')
      record_ += " " + std::to_string(value);
    else
      raw(std::int32_t(value), record_);
  }
  void real(double value) {
    if (s_.kind == 'f') {
      char text[64];
      std::snprintf(text, sizeof text, s_.number, value);
      record_ += std::string(record_.size() % 5 == 0 ? "\n  " : "  ") + text;
    } else if (s_.wide) {
      raw(value, record_);
    } else {
      raw(float(value), record_);
    }
  }
  void marker(std::int64_t count) {
    if (s_.marker == 8)
      raw(count, out_);
    else
      raw(std::int32_t(count), out_);
  }
  /// As gfortran does: the count before a part is negative when another follows, the count behind when another
  /// precedes.
  void close_record() {
    if (s_.kind != 'u') {
      out_ += record_ + (s_.kind == 'f' ? "\n" : "");
    } else {
      std::size_t const part = s_.longest_record > 0 ? std::size_t(s_.longest_record) : record_.size() + 1;
      std::size_t at = 0;
      do {
        std::size_t const n = std::min(part, record_.size() - at);
        bool const more = at + n<record_.size(), before = at> 0;
        marker(more ? -std::int64_t(n) : std::int64_t(n));
        out_ += record_.substr(at, n);
        marker(before ? -std::int64_t(n) : std::int64_t(n));
        at += n;
      } while (at < record_.size());
    }
    record_.clear();
  }

  Plot3dStorage s_;
  std::string record_, out_;
};

}  // namespace gridmorph::test
