#include <gridmorph/report/json_text.hpp>

#include <nlohmann/json.hpp>

namespace gridmorph {

std::string json_text(nlohmann::json const& json) {
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace gridmorph
