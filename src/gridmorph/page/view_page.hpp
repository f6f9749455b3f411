// One page with the pictures of meshes, since these have no words in them: where they are cut, and what colours mean.
#pragma once

#include <gridmorph/page/canvas.hpp>

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gridmorph::page {

/// What the colours of a picture mean: a scale with its ends, or names.
struct ColourKey {
  ColourScale const* scale = nullptr;
  double low = 0, high = 1;
  std::string what;
  std::vector<std::pair<Colour, std::string>> names;
};

struct ViewFigure {
  std::string file;            ///< name of its own, "section.png"
  std::string title, caption;  ///< text
  io::Picture picture;
  ColourKey key;
};

struct ViewPage {
  std::string version, files, summary;  ///< text
  std::vector<ViewFigure> figures;
  std::vector<ViewFigure> stages;  ///< shown one at a time
};

/// The page, with the pictures in it. Cost: packing them.
std::string view_page_text(ViewPage const& page);

/// Pictures of one height beside one another on white, a band between them. Cost: pixels.
io::Picture side_by_side(std::span<io::Picture const> pictures);

}  // namespace gridmorph::page
