#include <gridmorph/core/error.hpp>
#include <gridmorph/core/for_all.hpp>
#include <gridmorph/kernels/curved_element.hpp>
#include <gridmorph/mesh/unstructured_mesh.hpp>
#include <gridmorph/quality/block_cells.hpp>
#include <gridmorph/quality/design_box.hpp>
#include <gridmorph/quality/detail/design_search.hpp>
#include <gridmorph/quality/detail/partial_sums.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace gridmorph {

namespace {

using detail::DesignAnswer;
using detail::DesignCell;
using kernels::ElementCorners;
using kernels::JacobianSign;

/// The cells of a mesh of either kind, as elements.
class Cells {
 public:
  explicit Cells(IndexedMesh const& mesh) : mesh_(mesh) {
    // Found before threads ask for them.
    if (mesh.is_structured()) {
      blocks_.emplace(mesh.mesh());
      (void)mesh.handedness();
    } else {
      (void)mesh.signs();
      normal_ = plane_normal(mesh.mesh());
    }
  }

  [[nodiscard]] Index size() const { return mesh_.n_cells(); }
  [[nodiscard]] kernels::ElementType type(Index c) const {
    return blocks_ ? kernels::ElementType::hexahedron : mesh_.mesh().elements.type[c];
  }
  [[nodiscard]] double sign(Index c) const {
    return blocks_ ? mesh_.handedness()[std::size_t(blocks_->zone(c))] : mesh_.signs()[std::size_t(c)];
  }
  [[nodiscard]] Vec3 const& normal() const { return normal_; }
  [[nodiscard]] Coordinates const& coordinates() const { return mesh_.mesh().coordinates; }
  [[nodiscard]] detail::CellPlace place(Index c) const {
    return blocks_ ? detail::place_of_cell(mesh_.mesh(), c) : detail::place_of_element(mesh_.mesh(), c);
  }
  /// The corners in the order of elements.
  void nodes(Index c, Index (&out)[kernels::max_corners]) const {
    if (!blocks_) {
      auto const of = mesh_.mesh().elements.corners(c);
      std::copy(of.begin(), of.end(), out);
      return;
    }
    constexpr int of_blocks[kernels::max_corners] = {0, 1, 3, 2, 4, 5, 7, 6};
    detail::CellNodes const cell = blocks_->nodes(c);
    for (int k = 0; k < kernels::max_corners; ++k) out[k] = cell.node(of_blocks[k]);
  }

 private:
  IndexedMesh const& mesh_;
  std::optional<detail::BlockCells> blocks_;
  Vec3 normal_{0, 0, 1};
};

ElementCorners corners_of(Index const (&nodes)[kernels::max_corners], int count, Coordinates const& x) {
  ElementCorners out;
  for (int k = 0; k < count; ++k) out.at[k] = x[nodes[k]];
  return out;
}

void check(Mesh const& mesh, DesignModes const& designs) {
  std::string const who = "gridmorph::certify_designs: ";
  auto const fits = [&](Coordinates const& x, std::string const& name) {
    if (x.size() != mesh.n_nodes())
      throw ConfigError(who + name + " has " + std::to_string(x.size()) + " nodes, and the mesh has " +
                        std::to_string(mesh.n_nodes()));
  };
  fits(designs.centre, "the centre");
  for (std::size_t i = 0; i < designs.modes.size(); ++i) fits(designs.modes[i], "mode " + std::to_string(i + 1));
  if (!mesh.polyhedra.element.empty())
    throw ConfigError(who +
                      "the mesh has polyhedra, whose Jacobians have no bounds over a box of designs; other cells have");
  for (Index e = 0; e < mesh.elements.size(); ++e)
    if (kernels::is_second_order(mesh.elements.type[e], Index(mesh.elements.nodes[e].size())))
      throw ConfigError(who + "element " + std::to_string(e + 1) +
                        " is of second order, and bounds over a box of designs are there for straight ones; elements "
                        "of first order have them");
}

class Certifier {
 public:
  Certifier(HostInstance const& host, IndexedMesh const& mesh, DesignModes const& designs,
            DesignBoxOptions const& options)
      : host_(host), cells_(mesh), designs_(designs), options_(options), scale_(std::size_t(cells_.size())) {}

  DesignBox operator()() {
    out_.cells = cells_.size();
    screen_by_norms();
    look_for_witness();
    screen_by_slopes();
    look_for_witness();
    search();
    conclude();
    return out_;
  }

 private:
  [[nodiscard]] DesignCell cell(Index c) const {
    Index nodes[kernels::max_corners];
    cells_.nodes(c, nodes);
    kernels::ElementType const type = cells_.type(c);
    DesignCell out{type, cells_.sign(c),    cells_.normal(), corners_of(nodes, n_corners(type), designs_.centre),
                   {},   designs_.deviation};
    for (Coordinates const& mode : designs_.modes) out.modes.push_back(corners_of(nodes, n_corners(type), mode));
    return out;
  }
  /// The sign that a cell has in the mesh itself, whose handedness and numbering signs are.
  [[nodiscard]] JacobianSign sign_in_mesh(Index c) const {
    Index nodes[kernels::max_corners];
    cells_.nodes(c, nodes);
    kernels::ElementType const type = cells_.type(c);
    return kernels::jacobian_sign(type, corners_of(nodes, n_corners(type), cells_.coordinates()), cells_.sign(c),
                                  cells_.normal());
  }
  [[nodiscard]] std::vector<double> at_centre() const { return std::vector<double>(designs_.modes.size(), 0); }

  /// The size up to which norms, and where these do not reach `enough` slopes, show a cell to be valid.
  [[nodiscard]] double screened(Index c, double enough) const {
    Index nodes[kernels::max_corners];
    cells_.nodes(c, nodes);
    kernels::ElementType const type = cells_.type(c);
    int const n = n_corners(type);
    kernels::DesignQuestion const ask{
        int(designs_.modes.size()), cells_.sign(c), cells_.normal(), options_.limit, enough, designs_.deviation};
    auto const mode = [&](int i) { return corners_of(nodes, n, designs_.modes[i]); };
    return kernels::with_element_type(type,
                                      [&]<kernels::ElementType of>() {
                                        return kernels::screen_design_cell<of>(corners_of(nodes, n, designs_.centre),
                                                                               mode, ask);
                                      })
        .scale;
  }

  void screen_by_norms() {
    detail::for_all(host_, "gridmorph::certify_designs::norms", cells_.size(),
                    [&](Index c) { scale_[c] = screened(c, 0); });
  }

  /// Cells that are not known to be valid up to the size that is in question, those that may be broken first in front.
  [[nodiscard]] std::vector<Index> open_cells(double size) const {
    std::vector<Index> out;
    for (Index c = 0; c < cells_.size(); ++c)
      if (scale_[c] < size) out.push_back(c);
    std::stable_sort(out.begin(), out.end(), [&](Index a, Index b) { return scale_[a] < scale_[b]; });
    return out;
  }
  [[nodiscard]] double in_question() const { return std::min(options_.limit, out_.broken); }

  /// A design that breaks one of the cells that look worst.
  void look_for_witness() {
    constexpr Index most = 256;
    std::vector<Index> open = open_cells(in_question());
    if (Index(open.size()) > most) open.resize(most);
    std::vector<detail::BrokenCell> found(open.size());
    double const limit = in_question();
    detail::for_all_parts(host_, "gridmorph::certify_designs::witness", Index(open.size()), [&](Index k) {
      DesignCell const of = cell(open[k]);
      if (of.sign_at(at_centre()) < JacobianSign::zero) found[k] = look_for_broken_design(of, limit);
    });
    for (std::size_t k = 0; k < open.size(); ++k) take(open[k], found[k]);
  }
  void take(Index c, detail::BrokenCell const& broken) {
    if (!broken.found() || !(broken.scale < out_.broken)) return;
    out_.broken = broken.scale;
    out_.design = broken.t;
    place(c);
  }
  void place(Index c) {
    auto const at = cells_.place(c);
    out_.zone = at.zone;
    out_.cell = at.cell;
  }

  void screen_by_slopes() {
    double const enough = in_question();
    std::vector<Index> const open = open_cells(enough);
    out_.by_slopes = Index(open.size());
    std::vector<JacobianSign> sign(open.size(), JacobianSign::positive), before = sign;
    detail::for_all(host_, "gridmorph::certify_designs::slopes", Index(open.size()), [&](Index k) {
      scale_[open[k]] = screened(open[k], enough);
      if (scale_[open[k]] != 0) return;
      sign[k] = cell(open[k]).sign_at(at_centre());
      before[k] = sign_in_mesh(open[k]);
    });
    for (std::size_t k = 0; k < open.size(); ++k) {
      // A cell that is sound in the mesh and not at the centre is what the box is asked about: broken there.
      if (before[k] == JacobianSign::positive) {
        if (sign[k] >= JacobianSign::negative) take(open[k], {0, at_centre()});
        continue;
      }
      (before[k] == JacobianSign::zero ? out_.flat : out_.negative) += 1;
      scale_[open[k]] = kernels::unbounded;
    }
  }

  /// What is open is searched at a size a little below what is known to break, until nothing is broken there.
  void search() {
    constexpr int most_rounds = 24;
    double size = in_question();
    for (int round = 0; round < most_rounds; ++round) {
      if (out_.broken <= options_.limit) size = std::min(size, out_.broken * (1 - options_.tolerance));
      std::vector<Index> const open = open_cells(size);
      if (round == 0) out_.searched = Index(open.size());
      std::vector<DesignAnswer> answers(open.size());
      detail::for_all_parts(host_, "gridmorph::certify_designs::search", Index(open.size()),
                            [&](Index k) { answers[k] = search_designs(cell(open[k]), size, options_.most_pieces); });
      double const broken_before = out_.broken;
      std::vector<Index> undecided;
      for (std::size_t k = 0; k < open.size(); ++k) {
        if (answers[k].kind == DesignAnswer::Kind::valid) scale_[open[k]] = size;
        if (answers[k].kind == DesignAnswer::Kind::broken) take(open[k], answers[k].broken);
        if (answers[k].kind == DesignAnswer::Kind::undecided) undecided.push_back(open[k]);
      }
      if (out_.broken < broken_before) continue;
      settle(undecided, size);
      return;
    }
  }

  /// Cells that could not be decided at a size, at smaller ones.
  void settle(std::vector<Index> const& undecided, double size) {
    constexpr int halvings = 6;
    detail::for_all_parts(host_, "gridmorph::certify_designs::settle", Index(undecided.size()), [&](Index k) {
      Index const c = undecided[k];
      DesignCell const of = cell(c);
      double low = scale_[c], high = size;
      for (int h = 0; h < halvings; ++h) {
        double const middle = 0.5 * (low + high);
        bool const valid = search_designs(of, middle, options_.most_pieces).kind == DesignAnswer::Kind::valid;
        (valid ? low : high) = middle;
      }
      scale_[c] = low;
    });
  }

  void conclude() {
    double least = options_.limit;
    Index worst = -1;
    for (Index c = 0; c < cells_.size(); ++c)
      if (scale_[c] < least) {
        least = scale_[c];
        worst = c;
      }
    out_.certified = least;
    if (out_.zone < 0 && worst >= 0) place(worst);
  }

  HostInstance const& host_;
  Cells cells_;
  DesignModes const& designs_;
  DesignBoxOptions const& options_;
  std::vector<double> scale_;  ///< per cell: valid up to here
  DesignBox out_;
};

}  // namespace

DesignBox certify_designs(HostInstance const& host, IndexedMesh const& mesh, DesignModes const& designs,
                          DesignBoxOptions const& options) {
  check(mesh.mesh(), designs);
  return Certifier(host, mesh, designs, options)();
}

}  // namespace gridmorph
