#include <gridmorph/report/block_graph_text.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace gridmorph {

namespace {

std::string xml_text(std::string const& text) {
  std::string out;
  for (char const c : text) switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      default: out += c;
    }
  return out;
}

/// The first letters, where there are more than fit; UTF-8 stays whole.
std::string shortened(std::string const& text, std::size_t most) {
  if (text.size() <= most) return text;
  std::size_t end = most - 1;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;
  return text.substr(0, end) + "\u2026";
}

struct Place {
  double x = 0, y = 0;  ///< of the upper left corner
};

class Drawing {
 public:
  explicit Drawing(BlockGraph const& graph)
      : graph_(graph), node_(graph.blocks.size()), placed_(graph.blocks.size(), 0) {
    double area = 0;
    for (BlockGraph::Chain const& chain : graph.chains)
      area += (width_of(chain) + between_chains) * (height + between_lines);
    widest_ = std::max(narrowest, std::sqrt(landscape * area));
  }

  std::string text() {
    lay_out();
    for (BlockGraph::Interface const& face : graph_.interfaces) draw(face);
    for (std::size_t b = 0; b < node_.size(); ++b)
      if (placed_[b] != 0) draw_node(b);
    legend();
    return fmt::format(
               "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
               "{1:.0f}\" "
               "font-family=\"Helvetica, Arial, sans-serif\" font-size=\"11\">\n"
               "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
               width_ + margin, y_ + margin) +
           chains_ + edges_ + nodes_ + "</svg>\n";
  }

 private:
  // Lengths in pixels; text is 11 high, about 6 per letter, 7 where it is large.
  static constexpr double node_width = 186, node_height = 40, between_nodes = 34, padding = 10, heading = 20,
                          letter = 7;
  static constexpr double between_chains = 26, between_lines = 46, between_stages = 64, margin = 24, narrowest = 1240,
                          landscape = 1.6;
  static constexpr std::size_t longest_end = 22, longest_name = 32;

  /// Chains side by side in lines, a stage below the other.
  void lay_out() {
    y_ = margin;
    for (std::size_t s = 0; s < graph_.stages.size(); ++s) {
      chains_ += fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"14\" font-weight=\"bold\" fill=\"{}\">{}</text>\n",
                             margin, y_ + 6, stage_colour(s), xml_text(graph_.stages[s]));
      y_ += 18;
      double x = margin;
      for (std::size_t c = 0; c < graph_.chains.size(); ++c) {
        if (graph_.chains[c].stage != int(s)) continue;
        double const width = width_of(graph_.chains[c]);
        if (x > margin && x + width > widest_) {
          x = margin;
          y_ += height + between_lines;
        }
        place_chain(graph_.chains[c], {x, y_}, width);
        x += width + between_chains;
      }
      y_ += height + between_stages;
    }
    place_others();
    y_ -= between_stages;
  }

  static constexpr double height = heading + node_height + 2 * padding;

  static double width_of_end(std::string const& end) {
    return end.empty() ? 0 : letter * double(std::min(end.size(), longest_end)) + 8;
  }
  static double width_of(BlockGraph::Chain const& chain) {
    double const n = double(chain.blocks.size());
    return 2 * padding + width_of_end(chain.ends[0]) + width_of_end(chain.ends[1]) + n * node_width +
           (n - 1) * between_nodes;
  }

  void place_chain(BlockGraph::Chain const& chain, Place const& at, double width) {
    auto const colour = stage_colour(std::size_t(chain.stage));
    width_ = std::max(width_, at.x + width);
    chains_ += fmt::format(
        "<g><title>{}</title><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"9\" fill=\"{}\" "
        "fill-opacity=\"0.22\" "
        "stroke=\"{}\"/>\n<text x=\"{}\" y=\"{}\" font-weight=\"bold\">{}</text></g>\n",
        xml_text(chain.reason), at.x, at.y, width, height, colour, colour, at.x + padding, at.y + 15, chain.number);
    double const middle = at.y + heading + padding + node_height / 2;
    double x = at.x + padding;
    end_text(chain.ends[0], x, middle);
    x += width_of_end(chain.ends[0]);
    for (std::size_t n = 0; n < chain.blocks.size(); ++n) {
      auto const b = std::size_t(chain.blocks[n]);
      node_[b] = {x, middle - node_height / 2};
      placed_[b] = 1;
      x += node_width;
      if (n + 1 == chain.blocks.size()) break;
      edges_ += fmt::format(
          "<path d=\"M {0} {1} H {2} m -7 -5 l 7 5 l -7 5\" fill=\"none\" stroke=\"{3}\" stroke-width=\"2.5\"/>\n", x,
          middle, x + between_nodes - 2, colour);
      along_.emplace_back(std::min(chain.blocks[n], chain.blocks[n + 1]),
                          std::max(chain.blocks[n], chain.blocks[n + 1]));
      x += between_nodes;
    }
    end_text(chain.ends[1], x + 8, middle);
  }

  void end_text(std::string const& end, double x, double middle) {
    if (end.empty()) return;
    chains_ += fmt::format("<text x=\"{}\" y=\"{}\" font-style=\"italic\"><title>{}</title>{}</text>\n", x, middle + 4,
                           xml_text(end), xml_text(shortened(end, longest_end)));
  }

  /// Blocks that rules move as they are.
  void place_others() {
    double x = margin;
    bool any = false;
    for (std::size_t b = 0; b < node_.size(); ++b) {
      if (placed_[b] != 0) continue;
      if (!any) {
        chains_ += fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"14\" font-weight=\"bold\">moved by rules</text>\n",
                               margin, y_ + 6);
        y_ += 18;
      } else if (x + node_width > widest_) {
        x = margin;
        y_ += node_height + between_lines;
      }
      any = true;
      node_[b] = {x, y_};
      placed_[b] = 1;
      width_ = std::max(width_, x + node_width);
      x += node_width + between_chains;
    }
    if (any) y_ += node_height + between_stages;
  }

  void draw_node(std::size_t b) {
    BlockGraph::Block const& block = graph_.blocks[b];
    std::string title = block.name;
    if (block.other_zones > 0) title += fmt::format(" and {} more zones", block.other_zones);
    for (std::size_t p = 0; p < block.patches.size(); ++p) title += (p == 0 ? "; " : ", ") + block.patches[p];
    auto const more = block.other_zones > 0 ? fmt::format(", {} zones", block.other_zones + 1) : std::string();
    nodes_ += fmt::format(
        "<g><title>{}</title><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"4\" fill=\"white\" "
        "stroke=\"#24292f\"/>\n"
        "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text><text x=\"{}\" y=\"{}\" text-anchor=\"middle\" "
        "fill=\"#5a626c\">{} cells{}</text></g>\n",
        xml_text(title), node_[b].x, node_[b].y, node_width, node_height, node_[b].x + node_width / 2, node_[b].y + 16,
        xml_text(shortened(block.name, longest_name)), node_[b].x + node_width / 2, node_[b].y + 31, block.cells, more);
  }

  /// From the lower edge of the upper block to the upper edge of the lower one; below both where they stand in one
  /// line.
  void draw(BlockGraph::Interface const& face) {
    bool const is_along = std::find(along_.begin(), along_.end(), std::pair(face.a, face.b)) != along_.end();
    if (is_along && !face.periodic) return;  // the chain's arrow says so
    Place a = node_[face.a], b = node_[face.b];
    if (b.y < a.y) std::swap(a, b);
    std::string path;
    double const ax = a.x + node_width / 2, bx = b.x + node_width / 2, below = a.y + node_height;
    if (face.a == face.b)
      path = fmt::format("M {} {} c 10 22, 40 22, 50 0", ax - 25, below);
    else if (a.y == b.y)
      path = fmt::format("M {} {} C {} {}, {} {}, {} {}", ax, below, ax, below + 46, bx, below + 46, bx, below);
    else
      path = fmt::format("M {} {} C {} {}, {} {}, {} {}", ax, below, ax, below + 50, bx, b.y - 50, bx, b.y);
    edges_ += fmt::format("<path d=\"{}\" fill=\"none\" {}><title>{} faces{}</title></path>\n", path,
                          face.periodic ? "stroke=\"#b3261e\" stroke-dasharray=\"5 4\" stroke-width=\"1.3\""
                                        : "stroke=\"#8a8f98\" stroke-width=\"1.3\"",
                          face.faces, face.periodic ? ", periodic" : "");
  }

  void legend() {
    nodes_ += fmt::format(
        "<text x=\"{}\" y=\"{}\" fill=\"#5a626c\">boxes: blocks; colours: stages, top to bottom in their order; "
        "arrows: along "
        "chains; grey: interfaces; dashed: periodic</text>\n",
        margin, y_ + 2.5 * margin);
    y_ += 2.5 * margin;
    width_ = std::max(width_, 760.0);
  }

  BlockGraph const& graph_;
  std::vector<Place> node_;
  std::vector<char> placed_;
  std::vector<std::pair<int, int>> along_;  ///< neighbours in a chain, a < b
  std::string chains_, edges_, nodes_;
  double y_ = 0, width_ = 0;
  double widest_ = 0;  ///< where lines of chains end: drawings of hundreds stay about as high as wide
};

}  // namespace

std::string svg_text(BlockGraph const& graph) { return Drawing(graph).text(); }

}  // namespace gridmorph
