// Rules that give common nodes of patches, or a node and its periodic copy, different displacements, as messages.
#pragma once

#include <gridmorph/boundary/boundary.hpp>
#include <gridmorph/geometry/rigid_transform.hpp>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph {

/// One of the two that disagree on a node.
struct Disagreeing {
  std::string name;         ///< "'hub'", as users know it: its family where it has one
  std::string where;        ///< the place of its rule, as messages name it
  Vec3 displacement;        ///< the displacement that it gives the node
  bool by_default = false;  ///< whether no rule names it
  std::string advice;       ///< what its rule could be instead
};

/// Collects nodes on which patches disagree; one message for each two names, however many patches, zones and nodes they
/// have in common.
class Disagreements {
 public:
  /// The number of messages that are written out at most.
  static constexpr std::size_t most = 6;

  void add(Index node, Disagreeing const& first, Disagreeing const& second);

  [[nodiscard]] bool empty() const { return found_.empty(); }

  /// The messages, those about the most nodes first. `points_of(name)`: the nodes of what has that name, patch by
  /// patch, from which is told what rule it could have.
  template <class PointsOf>
  [[nodiscard]] std::vector<std::string> messages(Boundary const& boundary, Axis const& axis,
                                                  PointsOf const& points_of) const {
    std::vector<std::string> out;
    for (auto const* one : largest()) {
      std::string text = statement(boundary, *one);
      std::size_t const silent = text.size();
      for (Disagreeing const* side : {&one->second.first, &one->second.second})
        if (side->by_default) text += "; " + missing_rule(boundary, axis, side->name, points_of(side->name));
      for (Disagreeing const* side : {&one->second.first, &one->second.second})
        if (text.size() == silent && !side->advice.empty()) text += "; " + side->advice;
      if (text.size() == silent)
        text += "; make the two motions agree there, let one of them slip, or give the rules different ranks";
      out.push_back(std::move(text));
    }
    if (found_.size() > most)
      out.push_back("and " + std::to_string(found_.size() - most) + " more pairs of patches disagree");
    return out;
  }

 private:
  struct Found {
    Disagreeing first, second;  ///< where they are farthest apart
    double gap = 0;
    Index node = 0, count = 0;
  };
  using Pair = std::pair<std::pair<std::string, std::string> const, Found>;

  [[nodiscard]] std::vector<Pair const*> largest() const;
  [[nodiscard]] static std::string statement(Boundary const& boundary, Pair const& pair);
  [[nodiscard]] static std::string missing_rule(Boundary const& boundary, Axis const& axis, std::string const& name,
                                                std::vector<std::vector<Vec3>> const& patches);

  std::map<std::pair<std::string, std::string>, Found> found_;
};

/// Collects nodes whose periodic copies one rule moves in another way; one message for each rule, with what would fit.
class TornCopies {
 public:
  struct Copies {
    Index node = 0, copy = 0;
    Vec3 displacement, of_copy;  ///< in the frame of the node
    double turn_rad = 0;         ///< from one to the other; 0: a translation
  };

  /// `rule`: where it is given; `name`: of its rule; `patch`: of the node, as users know it.
  void add(std::string const& rule, std::string const& name, std::string const& patch, Copies const& copies);

  [[nodiscard]] std::vector<std::string> messages(Boundary const& boundary) const;

 private:
  struct Found {
    std::string name, patch;
    Copies worst;
    double gap = 0;
    Index count = 0;
  };
  std::map<std::string, Found> found_;
};

}  // namespace gridmorph
