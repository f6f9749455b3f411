#include <gridmorph/io/cgns/cgns_version.hpp>

#include <cgnslib.h>

namespace gridmorph {

std::string cgns_version() {
  return std::to_string(CGNS_VERSION / 1000) + "." + std::to_string(CGNS_VERSION / 100 % 10) + "." +
         std::to_string(CGNS_VERSION / 10 % 10);
}

}  // namespace gridmorph
