#include <gridmorph/motion/inflation_heights.hpp>

#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>

#include <algorithm>
#include <tuple>

namespace gridmorph {

HeightTable::HeightTable(std::vector<Station> stations, SpanwiseTable::Interpolation interpolation)
    : interpolation_(interpolation),
      has_sides_(std::any_of(stations.begin(), stations.end(), [](Station const& s) { return s.side != 0; })) {
  auto const place = [](Station const& s) { return std::tuple(s.span, s.chord); };
  std::sort(stations.begin(), stations.end(), [&](Station const& a, Station const& b) { return place(a) < place(b); });
  for (int k = 0; k < (has_sides_ ? 2 : 1); ++k) {
    auto& rows = rows_[k];
    for (Station const& s : stations) {
      if (has_sides_ && s.side != 0 && (s.side > 0) != (k == 1)) continue;
      if (rows.empty() || rows.back().first != s.span) rows.push_back({s.span, {{}, interpolation}});
      auto& along = rows.back().second.stations;
      if (!along.empty() && along.back().first == s.chord)
        throw MotionError("two heights at span fraction " + to_text(s.span, 6) + ", chord fraction " +
                          to_text(s.chord, 6) + "; give each place one");
      along.emplace_back(s.chord, s.height);
    }
    if (rows.empty())
      throw MotionError(has_sides_ ? std::string("no heights on side ") + (k == 1 ? "1" : "-1") +
                                         "; give some there, 0 where nothing is raised"
                                   : "no heights");
  }
}

double HeightTable::at(double span, double chord, double side) const {
  auto const& rows = rows_[has_sides_ && side > 0 ? 1 : 0];
  SpanwiseTable along{{}, interpolation_};
  for (auto const& [station, heights] : rows) along.stations.emplace_back(station, heights.at(chord));
  return along.at(span);
}

}  // namespace gridmorph
