// [[clearance]] of a case file on a mesh, whatever moves it.
#pragma once

#include <gridmorph/app/casefile/case_file.hpp>
#include <gridmorph/mesh/mesh.hpp>
#include <gridmorph/report/tip_clearance.hpp>

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace gridmorph::cli {

/// The tips and walls of a mesh by their nodes, found once.
class Clearances {
 public:
  /// Numbers of the nodes of patches; throws MotionError for selectors that name none.
  using NodesOf = std::function<std::vector<Index>(std::vector<std::string> const& selectors)>;
  /// Fills in what moves nodes whether or not the mesh keeps them on the wall; false where that is not known.
  using ByRule = std::function<bool(std::span<Index const> nodes, std::span<Vec3> displacement)>;

  /// `baseline`: coordinates of the mesh. It and `case_file` must outlive this. Throws MotionError for walls that are not of revolution.
  Clearances(CaseFile const& case_file, Coordinates const& baseline, NodesOf nodes_of);

  [[nodiscard]] bool empty() const { return tips_.empty(); }
  [[nodiscard]] std::size_t size() const { return tips_.size(); }
  [[nodiscard]] std::vector<Index> const& nodes_of_tip(std::size_t t) const { return tips_[t].nodes; }
  /// Of tip t in a morphed mesh.
  [[nodiscard]] TipClearance of(std::size_t t, Coordinates const& morphed, ByRule const& by_rule) const;
  /// Number of the rule of the case file that names all of these nodes, ascending; -1 where there is none.
  [[nodiscard]] int rule_of(std::span<Index const> nodes) const;

 private:
  struct Tip {
    std::string name;
    std::vector<Index> wall, nodes;  ///< ascending
    bool wall_moves = false;
    double outwards = 1;  ///< see ClearanceWall::of()
    ClearanceWall before;
  };

  CaseFile const& case_file_;
  Coordinates const& baseline_;
  NodesOf nodes_of_;
  std::vector<Tip> tips_;
};

}  // namespace gridmorph::cli
