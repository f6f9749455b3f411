#include <gridmorph/core/csr_graph.hpp>
#include <gridmorph/core/error.hpp>
#include <gridmorph/core/index.hpp>
#include <gridmorph/io/element_orders.hpp>
#include <gridmorph/io/gmsh/gmsh_file.hpp>
#include <gridmorph/io/printable.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <set>
#include <utility>
#include <vector>

namespace gridmorph::gmsh {

namespace {

/// Places of numbers in a list: by a table where they are dense, else by search.
class TagPlaces {
 public:
  /// Returns the first place of a number that is there a second time; -1 where each is there once.
  Index set(std::vector<std::int64_t> const& tags) {
    table_.clear();
    sorted_.clear();
    if (tags.empty()) return -1;
    auto const [low, high] = std::minmax_element(tags.begin(), tags.end());
    constexpr std::uint64_t few = 1024, spread = 4;
    low_ = *low;
    if (std::uint64_t(*high) - std::uint64_t(*low) < spread * tags.size() + few) {
      table_.assign(std::size_t(*high - *low) + 1, -1);
      for (std::size_t n = 0; n < tags.size(); ++n) {
        Index32& place = table_[tags[n] - low_];
        if (place >= 0) return Index(n);
        place = Index32(n);
      }
      return -1;
    }
    for (std::size_t n = 0; n < tags.size(); ++n) sorted_.emplace_back(tags[n], Index32(n));
    std::sort(sorted_.begin(), sorted_.end());
    Index32 twice = -1;
    for (std::size_t n = 1; n < sorted_.size(); ++n)
      if (sorted_[n].first == sorted_[n - 1].first && (twice < 0 || sorted_[n].second < twice))
        twice = sorted_[n].second;
    return twice;
  }

  /// -1 where there is no such number.
  [[nodiscard]] Index find(std::int64_t tag) const {
    if (!table_.empty()) return tag < low_ || tag - low_ >= Index(table_.size()) ? -1 : table_[tag - low_];
    auto const at = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair(tag, Index32(-1)));
    return at == sorted_.end() || at->first != tag ? -1 : at->second;
  }

 private:
  std::int64_t low_ = 0;
  std::vector<Index32> table_;
  std::vector<std::pair<std::int64_t, Index32>> sorted_;
};

constexpr int most_dimensions = 3;

class Parser {
 public:
  explicit Parser(Text& text) : text_(text), version_(text.format().version) {}

  File run() {
    for (std::string name = text_.section(); !name.empty(); name = text_.section()) {
      bool const is_nodes = name == "Nodes" || name == "ParametricNodes";
      if ((is_nodes && has_nodes_) || (name == "Elements" && has_elements_))
        text_.fail("$" + name + " for the second time");
      if ((name == "Elements" || name == "Periodic") && !has_nodes_) text_.fail("$" + name + " comes before $Nodes");
      if (name == "PartitionedEntities" && version_ != 41)
        text_.fail(
            "is a mesh in parts of version 4.0, read are those of 4.1; write it again: gmsh -save FILE -format "
            "msh41 -o mesh.msh");
      if (is_nodes)
        nodes(name == "ParametricNodes");
      else if (name == "Elements")
        elements();
      else if (name == "PhysicalNames")
        physical_names();
      else if (name == "Entities" && version_ >= 40)
        entities();
      else if (name == "PartitionedEntities")
        parts();
      else if (name == "Periodic")
        periodic();
      else {
        text_.skip_section(name);
        // What cells of other parts a part sees is a copy of what is in the file anyway.
        if (name != "Comments" && name != "GhostElements") out_.passed_over.push_back("$" + name);
        continue;
      }
      text_.end_section(name);
    }
    if (!has_nodes_ || !has_elements_)
      text_.fail(std::string("has no ") + (has_nodes_ ? "$Elements" : "$Nodes") + "; get a whole copy of the file");
    return std::move(out_);
  }

 private:
  [[nodiscard]] bool old() const { return version_ == 22; }

  // Nodes

  void add_node(std::int64_t tag, std::size_t tag_at) {
    if (tag < 0) text_.fail_at(tag_at, "a node has the number " + std::to_string(tag));
    out_.tag.push_back(tag);
  }
  void coordinates() {
    std::size_t const begin = text_.at();
    for (int c = 0; c < 3; ++c) out_.coordinates.push_back(text_.real("a coordinate"));
    out_.at.push_back(begin);
  }

  void nodes(bool with_parameters) {
    has_nodes_ = true;
    try {
      if (old())
        old_nodes(with_parameters);
      else
        node_blocks();
    } catch (IoError const&) {
      refuse_repeated_nodes();  // what comes first in the file is said first
      throw;
    }
    if (out_.tag.size() > std::size_t(std::numeric_limits<Index32>::max()))
      text_.fail("there are " + std::to_string(out_.tag.size()) + " nodes, more than can be handled");
    refuse_repeated_nodes();
  }

  void refuse_repeated_nodes() {
    auto const twice = places_.set(out_.tag);
    if (twice < 0) return;
    // Blocks of version 4.1 have all numbers before the coordinates.
    std::size_t const at = std::size_t(twice) < out_.at.size() ? out_.at[twice] : text_.at();
    text_.fail_at(at, "node " + std::to_string(out_.tag[twice]) + " is there twice");
  }

  void old_nodes(bool with_parameters) {
    out_.parametric = with_parameters;
    Index const n = text_.count_word("the number of nodes", 7);
    text_.begin_raw();
    reserve_nodes(n);
    for (Index k = 0; k < n; ++k) {
      std::size_t const begin = text_.at();
      add_node(text_.number32("a node number"), begin);
      coordinates();
      if (!with_parameters) continue;
      std::int64_t const dimension = text_.number32("the dimension of what a node lies on");
      text_.number32("what a node lies on");
      for (std::int64_t c = 0; c < dimension && dimension < 3; ++c) text_.skip_real("a parameter");
    }
  }

  void node_blocks() {
    text_.begin_raw();
    Index const n_blocks = text_.count("the number of blocks of nodes", 4, true);
    Index const n = text_.count("the number of nodes", 7, true);
    if (version_ == 41) {
      text_.number64("the smallest node number");
      text_.number64("the largest node number");
    }
    reserve_nodes(n);
    for (Index b = 0; b < n_blocks; ++b) {
      std::int64_t dimension = text_.number32("a dimension");
      std::int64_t const entity = text_.number32("the number of a piece of geometry");
      if (version_ == 40) dimension = entity;
      std::int64_t const with_parameters = text_.number32("0 or 1 for parameters");
      if (dimension < 0 || dimension > most_dimensions || with_parameters < 0 || with_parameters > 1)
        text_.fail("a block of nodes has dimension " + std::to_string(dimension) + " and parameters " +
                   std::to_string(with_parameters));
      out_.parametric = out_.parametric || with_parameters == 1;
      Index const size = text_.count("the number of nodes of a block", 7, true);
      if (Index(out_.tag.size()) + size > n)
        text_.fail("blocks hold more nodes than the " + std::to_string(n) + " of the section");
      if (version_ == 41)
        for (Index k = 0; k < size; ++k) {
          std::size_t const begin = text_.at();
          add_node(text_.number64("a node number"), begin);
        }
      for (Index k = 0; k < size; ++k) {
        if (version_ == 40) {
          std::size_t const begin = text_.at();
          add_node(text_.number32("a node number"), begin);
        }
        coordinates();
        for (std::int64_t c = 0; c < dimension && with_parameters == 1; ++c) text_.skip_real("a parameter");
      }
    }
    if (Index(out_.tag.size()) != n)
      text_.fail("blocks hold " + std::to_string(out_.tag.size()) + " nodes, and the section says " +
                 std::to_string(n));
  }

  void reserve_nodes(Index n) {
    out_.tag.reserve(n);
    out_.coordinates.reserve(3 * std::size_t(n));
    out_.at.reserve(n);
  }

  Index32 node(std::int64_t tag, std::size_t at, char const* of, std::int64_t number) const {
    Index const place = places_.find(tag);
    if (place < 0)
      text_.fail_at(at, std::string(of) + " " + std::to_string(number) + " has node " + std::to_string(tag) +
                            ", which is not among the " + std::to_string(out_.tag.size()) + " nodes of the file");
    return Index32(place);
  }

  // Elements

  void elements() {
    has_elements_ = true;
    if (old())
      old_elements();
    else
      element_blocks();
  }

  [[nodiscard]] io::FileShape shape_of(std::int64_t type) const {
    io::FileShape const out = io::gmsh_shape(type);
    if (out.dimension < 0)
      text_.fail("elements of type " + std::to_string(type) +
                 " are not read, those of first and second order are; write it again with fewer nodes: gmsh -save FILE "
                 "-order 1 -o mesh.msh");
    return out;
  }

  template <class Read>
  void element(std::int64_t type, io::FileShape const& f, std::int64_t number, Index32 group, Read const& read) {
    row_.clear();
    for (int k = 0; k < f.nodes; ++k) {
      std::size_t const begin = text_.at();
      row_.push_back(node(read(), begin, "element", number));
    }
    out_.type.push_back(std::uint8_t(type));
    out_.number.push_back(number);
    out_.group.push_back(group);
    out_.nodes.add(row_);
  }

  void old_elements() {
    out_.repeats_elements = true;
    Index const n = text_.count_word("the number of elements", 6);
    text_.begin_raw();
    auto const read = [&] { return text_.number32("a node number"); };
    bool const binary = text_.format().binary;
    for (Index e = 0; e < n;) {
      std::int64_t number = binary ? 0 : text_.number32("an element number");
      std::int64_t const type = text_.number32("an element type");
      io::FileShape const f = shape_of(type);
      // Binary files put elements of one type together behind one head.
      Index const size = binary ? text_.count("the number of elements of a type", 8, false) : 1;
      Index const n_tags = text_.count("the number of tags", binary ? 4 : 2, false);
      if (size < 1 || e + size > n)
        text_.fail("there are more elements than the " + std::to_string(n) + " of the section, or none of a type");
      for (Index k = 0; k < size; ++k, ++e) {
        if (binary) number = text_.number32("an element number");
        std::int64_t physical = 0, entity = 0;
        for (Index t = 0; t < n_tags; ++t) {
          std::int64_t const tag = text_.number32("a tag");
          if (t == 0) physical = tag < 0 ? -tag : tag;
          if (t == 1) entity = tag;
        }
        element(type, f, number, old_group(f.dimension, physical, entity), read);
      }
    }
  }

  Index32 old_group(int dimension, std::int64_t physical, std::int64_t entity) {
    std::array<std::int64_t, 3> const key{dimension, physical, entity};
    if (key == last_key_) return last_group_;
    auto const [found, is_new] = old_groups_.try_emplace(key, Index32(out_.groups.size()));
    if (is_new) {
      out_.groups.push_back({dimension, entity, {}});
      if (physical > 0) out_.groups.back().physical.push_back(physical);
    }
    last_key_ = key;
    return last_group_ = found->second;
  }

  void element_blocks() {
    text_.begin_raw();
    Index const n_blocks = text_.count("the number of blocks of elements", 4, true);
    Index const n = text_.count("the number of elements", 2, true);
    if (version_ == 41) {
      text_.number64("the smallest element number");
      text_.number64("the largest element number");
    }
    auto const read = [&] {
      return version_ == 41 ? text_.number64("a node number") : text_.number32("a node number");
    };
    for (Index b = 0; b < n_blocks; ++b) {
      std::int64_t dimension = text_.number32("a dimension");
      std::int64_t entity = text_.number32("the number of a piece of geometry");
      if (version_ == 40) std::swap(dimension, entity);
      std::int64_t const type = text_.number32("an element type");
      io::FileShape const f = shape_of(type);
      if (f.dimension != dimension)
        text_.fail("elements of type " + std::to_string(type) + " are said to have dimension " +
                   std::to_string(dimension));
      Index const size = text_.count("the number of elements of a block", 2 + 2 * std::size_t(f.nodes), true);
      if (out_.nodes.size() + size > n)
        text_.fail("blocks hold more elements than the " + std::to_string(n) + " of the section");
      auto const known = entities_.find({f.dimension, entity});
      out_.groups.push_back(known == entities_.end() ? Group{f.dimension, entity, {}} : known->second);
      for (Index k = 0; k < size; ++k)
        element(type, f, version_ == 41 ? text_.number64("an element number") : text_.number32("an element number"),
                Index32(out_.groups.size()) - 1, read);
    }
    if (out_.nodes.size() != n)
      text_.fail("blocks hold " + std::to_string(out_.nodes.size()) + " elements, and the section says " +
                 std::to_string(n));
  }

  // Groups

  void physical_names() {
    Index const n = text_.count_word("the number of names", 5);
    for (Index k = 0; k < n; ++k) {
      std::int64_t const dimension = text_.integer_word("a dimension");
      if (dimension < 0 || dimension > most_dimensions)
        text_.fail("a physical group has dimension " + std::to_string(dimension));
      std::int64_t const number = text_.integer_word("the number of a physical group");
      out_.names[{int(dimension), number}] = text_.quoted("a name");
    }
  }

  void entities() {
    text_.begin_raw();
    pieces_of_geometry([](Group&) {});
  }

  /// Pieces of the geometry that fall into parts of the mesh, as if they were whole: a piece of a part is what it is
  /// cut from.
  void parts() {
    text_.begin_raw();
    text_.number64("the number of parts");
    Index const n_ghosts = text_.count("the number of pieces of ghost elements", 4, true);
    for (Index k = 0; k < 2 * n_ghosts; ++k) text_.number32("a piece of ghost elements");
    pieces_of_geometry([&](Group& piece) {
      std::int64_t const dimension = text_.number32("the dimension of what a part is cut from");
      std::int64_t const whole = text_.number32("the number of what a part is cut from");
      if (dimension < piece.dimension || dimension > most_dimensions)
        text_.fail("a part of dimension " + std::to_string(piece.dimension) + " is cut from one of dimension " +
                   std::to_string(dimension));
      piece.between_parts = dimension > piece.dimension;
      piece.entity = whole;
      Index const n_parts = text_.count("the number of parts of a piece", 2, true);
      for (Index p = 0; p < n_parts; ++p) text_.number32("a part");
    });
  }

  /// `more` reads what comes behind the number of a piece.
  template <class More>
  void pieces_of_geometry(More const& more) {
    std::array<Index, 4> n{};
    for (Index& count : n) count = text_.count("the number of pieces of geometry", 4, true);
    for (int dimension = 0; dimension <= most_dimensions; ++dimension)
      for (Index k = 0; k < n[dimension]; ++k) {
        std::int64_t const tag = text_.number32("the number of a piece of geometry");
        Group piece{dimension, tag, {}};
        more(piece);
        int const box = dimension == 0 && version_ == 41 ? 3 : 6;
        for (int c = 0; c < box; ++c) text_.skip_real("a coordinate of a piece of geometry");
        std::set<std::int64_t> physical;
        Index const n_physical = text_.count("the number of physical groups", 2, true);
        for (Index p = 0; p < n_physical; ++p) {
          std::int64_t const group = text_.number32("a physical group");
          physical.insert(group < 0 ? -group : group);
        }
        piece.physical.assign(physical.begin(), physical.end());
        entities_[{dimension, tag}] = std::move(piece);
        if (dimension == 0) continue;
        Index const n_sides = text_.count("the number of pieces of a boundary", 2, true);
        for (Index s = 0; s < n_sides; ++s) text_.number32("a piece of a boundary");
      }
  }

  // Periodicity; in binary files of version 2.2 it is text, too.

  void periodic() {
    bool const words = version_ != 41;
    auto const integer = [&](char const* what) { return words ? text_.integer_word(what) : text_.number32(what); };
    auto const tag = [&] { return words ? text_.integer_word("a node number") : text_.number64("a node number"); };
    auto const count = [&](char const* what, std::size_t least) {
      return words ? text_.count_word(what, least) : text_.count(what, least, true);
    };
    if (!words) text_.begin_raw();
    Index const n = count("the number of periodic pieces", 8);
    for (Index k = 0; k < n; ++k) {
      PeriodicLink link;
      link.dimension = int(integer("a dimension"));
      link.entity = integer("the number of a piece of geometry");
      link.master = integer("the number of what it repeats");
      Index const n_affine =
          words ? (text_.passes("Affine") ? 16 : 0) : count("the number of entries of a transform", 2);
      if (n_affine != 0 && n_affine != 16)
        text_.fail("a periodic transform has " + std::to_string(n_affine) + " entries instead of 16");
      if (n_affine == 16) link.affine.emplace();
      for (Index a = 0; a < n_affine; ++a) (*link.affine)[a] = affine_entry(words);
      Index const n_pairs = count("the number of periodic nodes", 4);
      for (Index p = 0; p < n_pairs; ++p) {
        std::array<Index32, 2> pair{};
        for (Index32& side : pair) {
          std::size_t const begin = text_.at();
          side = node(tag(), begin, "periodic piece", link.entity);
        }
        link.nodes.push_back(pair);
      }
      out_.periodic.push_back(std::move(link));
    }
  }

  double affine_entry(bool words) {
    if (!words || !text_.format().binary) return text_.real("an entry of a transform");
    std::string const found(text_.word("an entry of a transform"));
    char* end = nullptr;
    double const value = std::strtod(found.c_str(), &end);
    if (end != found.c_str() + found.size())
      text_.fail("expected an entry of a transform, found '" + io::printable(found) + "'");
    return value;
  }

  Text& text_;
  int version_;
  File out_;
  TagPlaces places_;
  bool has_nodes_ = false, has_elements_ = false;
  std::map<std::pair<int, std::int64_t>, Group> entities_;  ///< by dimension and number in the file
  std::map<std::array<std::int64_t, 3>, Index32> old_groups_;
  std::array<std::int64_t, 3> last_key_{-1, -1, -1};
  Index32 last_group_ = -1;
  std::vector<Index32> row_;
};

}  // namespace

File parse(Text& text) { return Parser(text).run(); }

}  // namespace gridmorph::gmsh
