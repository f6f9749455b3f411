// [[clearance]] of a case file on a mesh, whatever moves it.
#pragma once

#include <gridmorph/boundary/inward_facets.hpp>
#include <gridmorph/case/case_file.hpp>
#include <gridmorph/report/tip_clearance.hpp>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace gridmorph::cli {

/// The tips and walls of a mesh by their nodes, found once.
class Clearances {
 public:
  /// Fills in what moves nodes whether or not the mesh keeps them on the wall; false where that is not known.
  using ByRule = std::function<bool(std::span<Index const> nodes, std::span<Vec3> displacement)>;

  /// `boundary`: of the baseline. `case_file` must outlive this. Throws MotionError for selectors that name no patches,
  /// and for walls without an area.
  Clearances(CaseFile const& case_file, Boundary boundary);

  [[nodiscard]] std::size_t size() const { return tips_.size(); }
  [[nodiscard]] std::vector<Index> const& nodes_of_tip(std::size_t t) const { return tips_[t].nodes; }
  /// The clearance of tip t in a morphed mesh.
  [[nodiscard]] TipClearance of(std::size_t t, Coordinates const& morphed, ByRule const& by_rule) const;
  /// Number of the rule of the case file that names all patches of a tip; -1 where there is none.
  [[nodiscard]] int rule_of_tip(std::size_t t) const { return tips_[t].rule; }

 private:
  using Wall = std::shared_ptr<ClearanceWall const>;
  /// Rows have pitches of their own.
  struct WallOfRow {
    InwardFacets facets;
    std::vector<RigidTransform> copies;
    std::vector<Index> standing;  ///< nodes of the wall that the tip's patches have too
  };
  struct Tip {
    std::string name;
    std::vector<Index> nodes;  ///< ascending
    int rule = -1;
    std::vector<Index> wall;  ///< ascending
    std::vector<WallOfRow> rows;
    bool wall_moves = false;
    double side = 1;  ///< see ClearanceWall::of()
    Wall before;
    Wall before_as_surface;  ///< where `before` is of revolution and a wall that moves may not stay so
  };

  [[nodiscard]] Coordinates const& baseline() const { return boundary_.coordinates(); }
  [[nodiscard]] std::vector<Index> nodes_of(std::vector<int> const& patches) const;
  [[nodiscard]] Tip tip(ClearanceCase const& one, std::vector<int> const& rule_of_patch) const;
  /// The wall as one of revolution; null where it is not, or where there is no axis.
  [[nodiscard]] Wall revolution(Tip const& tip, Coordinates const& x) const;
  [[nodiscard]] static Wall surface(Tip const& tip, Coordinates const& x);

  CaseFile const& case_file_;
  Boundary boundary_;
  std::vector<Tip> tips_;
};

}  // namespace gridmorph::cli
