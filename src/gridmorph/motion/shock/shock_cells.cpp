#include <gridmorph/motion/shock/shock_cells.hpp>

#include <gridmorph/boundary/selectors.hpp>
#include <gridmorph/core/disjoint_sets.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/text.hpp>
#include <gridmorph/motion/shock/fitted_gradient.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace gridmorph {

namespace {

using Sensor = ShockSearch::Sensor;

/// What the sensor says of one cell.
struct SensorReading {
  double value = 0;  ///< of the sensor
  double rise = 0;   ///< (max - min) / |mean| of the variable
  Vec3 gradient;     ///< of the variable
  Vec3 middle;
};

class SensorOfCells {
 public:
  SensorOfCells(Mesh const& mesh, FlowAtNodes const& flow, ShockSearch const& search)
      : mesh_(mesh), flow_(flow), search_(search) {}

  SensorReading read(std::span<Index const> corners) {
    SensorReading out;
    double const share = 1.0 / double(corners.size());
    double mean = 0, low = std::numeric_limits<double>::infinity(), high = -low;
    for (Index const n : corners) {
      double const q = flow_.variable[n];
      mean += share * q;
      low = std::min(low, q);
      high = std::max(high, q);
      out.middle += share * mesh_.coordinates[n];
    }
    out.rise = high > low ? (high - low) / std::max(std::abs(mean), std::numeric_limits<double>::min()) : 0;
    bool const looks = search_.sensor == Sensor::jump ? out.rise >= search_.least() : out.rise >= search_.compression;
    out.value = search_.sensor == Sensor::jump ? out.rise : 0;
    if (!looks || out.rise == 0) return out;
    offset_.clear();
    value_.clear();
    for (Index const n : corners) {
      offset_.push_back(mesh_.coordinates[n] - out.middle);
      value_.push_back(flow_.variable[n] - mean);
    }
    constexpr double flat = 1e-14;  // of squares: cells 1e7 times as long as they are thick
    out.gradient = fitted_gradient(offset_, value_, flat);
    if (search_.sensor == Sensor::normal_mach) out.value = normal_mach(corners, out.gradient);
    return out;
  }

 private:
  [[nodiscard]] double normal_mach(std::span<Index const> corners, Vec3 const& gradient) const {
    Vec3 v;
    double sound = 0;
    for (Index const n : corners) {
      auto const m = std::size_t(n);
      v += Vec3{flow_.velocity[0][m], flow_.velocity[1][m], flow_.velocity[2][m]};
      sound += flow_.sound[m];
    }
    double const steepness = norm(gradient);
    return sound > 0 && steepness > 0 ? dot(v, gradient) / (sound * steepness) : 0;
  }

  Mesh const& mesh_;
  FlowAtNodes const& flow_;
  ShockSearch const& search_;
  std::vector<Vec3> offset_;
  std::vector<double> value_;
};

class ShockFinder {
 public:
  ShockFinder(Mesh const& mesh, FlowSolution const& solution, ShockSearch const& search,
              std::vector<std::uint8_t> const& looked_at)
      : mesh_(mesh),
        solution_(solution),
        search_(search),
        looked_at_(looked_at),
        cells_(mesh),
        place_(cells_.one_across_periodic_sides()) {}

  ShockCells run() {
    find();
    drop_small_groups();
    collect();
    for (int layer = 0; layer < search_.grow; ++layer) grow();
    out_.summary = std::to_string(found_) + " cells in " + std::to_string(groups_) +
                   (groups_ == 1 ? " group" : " groups") + (search_.grow > 0 ? ", and layers around them" : "") + " (" +
                   name() + " up to " + to_text(largest_, 4) + ", " + solution_.source + ")" +
                   (dropped_ > 0 ? "; smaller groups, " + std::to_string(dropped_) + " cells, are left out" : "");
    return std::move(out_);
  }

 private:
  [[nodiscard]] std::string name() const {
    return search_.sensor == Sensor::jump ? "rise of " + search_.variable + " over a cell" : "normal Mach number";
  }

  void find() {
    FlowAtNodes const flow = flow_at_nodes(cells_, solution_, search_);
    SensorOfCells sensor(mesh_, flow, search_);
    out_.cells.assign(cells_.size(), 0);
    reading_.clear();
    Vec3 where;
    double steepest = 0;
    cells_.each([&](Index c, std::span<Index const> corners) {
      if (looked_at_[c] == 0) return;
      ++n_looked_at_;
      SensorReading const reading = sensor.read(corners);
      steepest = std::max(steepest, reading.rise);
      if (reading.value > largest_) {
        largest_ = reading.value;
        where = reading.middle;
      }
      if (!(reading.value >= search_.least())) return;
      out_.cells[c] = 1;
      reading_.emplace_back(c, reading);
    });
    if (reading_.empty()) none(where, steepest);
  }

  [[noreturn]] void none(Vec3 const& where, double steepest) const {
    std::string text = "none of the " + std::to_string(n_looked_at_) + " cells looked at is of a shock: ";
    if (search_.sensor == Sensor::normal_mach && largest_ <= 0)
      throw MotionError(text + "the pressure rises over none by " + to_text(search_.compression, 4) +
                        " of itself (compression) along the flow, by " + to_text(steepest, 4) +
                        " at most; lower compression, or correct where the region lies");
    // Rounded down, so that it holds that cell.
    double const unit = std::pow(10.0, std::floor(std::log10(std::max(largest_, 1e-300))) - 2);
    throw MotionError(text + "the " + name() + " is " + to_text(largest_, 6) + " at most, at " + to_text(where, 6) +
                      ", and the threshold " + to_text(search_.least(), 6) +
                      "; threshold = " + to_text(unit * std::floor(largest_ / unit), 3) + " or less would find some (" +
                      solution_.source + ")");
  }

  void drop_small_groups() {
    DisjointSets<Index> groups(std::size_t(cells_.n_nodes()));
    std::vector<Index> node(cells_.size(), -1);
    each_found([&](Index c, std::span<Index const> corners) {
      node[c] = place(corners.front());
      for (Index const n : corners) groups.join(place(corners.front()), place(n));
    });
    std::map<Index, Index> size;
    for (auto const& [c, reading] : reading_) ++size[groups.root(node[c])];
    Index most = 0;
    for (auto const& [root, n] : size) {
      most = std::max(most, n);
      if (n >= search_.smallest)
        ++groups_;
      else
        dropped_ += n;
    }
    if (groups_ == 0)
      throw MotionError(std::to_string(reading_.size()) + " cells reach the threshold, in " +
                        std::to_string(size.size()) + " groups of " + std::to_string(most) +
                        " at most, and smallest = " + std::to_string(search_.smallest) +
                        " drops them all; smallest = " + std::to_string(most) +
                        " would keep the largest, a lower threshold makes them larger (" + solution_.source + ")");
    std::erase_if(reading_, [&](auto const& found) {
      bool const small = size[groups.root(node[found.first])] < search_.smallest;
      if (small) out_.cells[found.first] = 0;
      return small;
    });
    found_ = Index(reading_.size());
  }

  /// The smallest number among a node, those at its place and their periodic copies: cells that share one are
  /// neighbours.
  [[nodiscard]] Index place(Index node) const { return place_[node]; }

  template <class Look>
  void each_found(Look const& look) const {
    cells_.each([&](Index c, std::span<Index const> corners) {
      if (out_.cells[c] != 0) look(c, corners);
    });
  }

  /// Collects the cells found with their weights: along the gradient the rise over a cell is what it has of the whole
  /// jump, across it its size is what it has of the shock.
  void collect() {
    std::size_t next = 0;
    Vec3 sum;
    each_found([&](Index, std::span<Index const> corners) {
      SensorReading const& reading = reading_[next++].second;
      double const size = extent_across(corners, reading);
      out_.points.push_back({reading.middle, reading.rise * size});
      double const steepness = norm(reading.gradient);
      if (steepness > 0) sum += (reading.rise * size / steepness) * reading.gradient;
    });
    double const length = norm(sum);
    if (length > 0) out_.direction = (1 / length) * sum;
  }

  /// The diagonal of what the corners span across the gradient: squared in three dimensions.
  [[nodiscard]] double extent_across(std::span<Index const> corners, SensorReading const& reading) const {
    double const steepness = norm(reading.gradient);
    Vec3 const along = steepness > 0 ? (1 / steepness) * reading.gradient : Vec3{};
    double most = 0;
    for (Index const n : corners) {
      Vec3 const d = mesh_.coordinates[n] - reading.middle;
      most = std::max(most, norm(d - dot(d, along) * along));
    }
    return mesh_.dimension == 3 ? most * most : most;
  }

  void grow() {
    std::vector<std::uint8_t> touched(cells_.n_nodes(), 0);
    each_found([&](Index, std::span<Index const> corners) {
      for (Index const n : corners) touched[place(n)] = 1;
    });
    cells_.each([&](Index c, std::span<Index const> corners) {
      for (Index const n : corners)
        if (touched[place(n)] != 0) out_.cells[c] = 1;
    });
  }

  Mesh const& mesh_;
  FlowSolution const& solution_;
  ShockSearch const& search_;
  std::vector<std::uint8_t> const& looked_at_;
  CellCorners cells_;
  std::vector<Index> place_;
  ShockCells out_;
  std::vector<std::pair<Index, SensorReading>> reading_;  ///< of the cells found, ascending
  Index n_looked_at_ = 0, found_ = 0, groups_ = 0, dropped_ = 0;
  double largest_ = 0;
};

}  // namespace

std::vector<std::string> shock_variables(ShockSearch const& search) {
  std::vector<std::string> out{"Pressure",  "Density",   "VelocityX", "VelocityY",     "VelocityZ",
                               "MomentumX", "MomentumY", "MomentumZ", "VelocitySound", "EnergyStagnationDensity"};
  if (search.sensor == Sensor::normal_mach) return out;
  if (search.variable != "Pressure") return {search.variable};
  return out;
}

std::vector<std::uint8_t> cells_looked_at(Mesh const& mesh, InnerRegion const& region) {
  if (!mesh.is_structured()) {
    InnerRegion of_places = region;
    of_places.cells.reset();
    of_places.only_measured = false;
    return elements_of_region(mesh, of_places);
  }
  return cells_of_region(mesh, region);
}

ShockCells find_shock(Mesh const& mesh, FlowSolution const& solution, ShockSearch const& search,
                      std::vector<std::uint8_t> const& looked_at) {
  return ShockFinder(mesh, solution, search, looked_at).run();
}

}  // namespace gridmorph
