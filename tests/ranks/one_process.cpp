#include "ranks/world.hpp"

namespace gridmorph::test {

std::shared_ptr<Ranks const> world() { return Ranks::alone(); }

}  // namespace gridmorph::test
