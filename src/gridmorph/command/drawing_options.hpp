// What `view` hands on to the scripts that draw: scripts/picture (meshes of blocks) and scripts/picture-unstructured
// (of elements). A test holds the list equal to what the scripts take.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::cli {

struct DrawingOption {
  std::string_view name;
  int values;
  std::string_view value_names, text;
  bool blocks, elements;  ///< whether meshes of each kind have it
};

inline constexpr std::array drawing_options{
    DrawingOption{"--plane", 1, "x=V", "Cut where a coordinate has a value (elements: y=0 if not given)", true, true},
    DrawingOption{"--span", 1, "S",
                  "Blocks: cut at a span fraction between hub (0) and case (1), 0.5 if nothing is given", true, false},
    DrawingOption{"--i", 1, "N", "Blocks: index plane i = N of every zone, 1-based", true, false},
    DrawingOption{"--j", 1, "N", "Blocks: index plane j = N", true, false},
    DrawingOption{"--k", 1, "N", "Blocks: index plane k = N", true, false},
    DrawingOption{"--axis", 1, "x|y|z", "Blocks: axis of the machine; taken from the periodic interfaces, else x", true,
                  false},
    DrawingOption{"--wall", 1, "FAMILY", "Blocks: wall of the close-ups; the first one met if not given", true, false},
    DrawingOption{"--box", 4, "X0 X1 Y0 Y1", "One more close-up, box.png", true, true},
    DrawingOption{
        "--color", 1, "WHAT",
        "Blocks: determinant, displacement, none, or with --plane a variable of the flow solution in both files; "
        "elements: type, none, or a solution of the file",
        true, true},
    DrawingOption{"--moved", 1, "LENGTH", "Blocks, with a variable: outline cells that move by at least this", true,
                  false},
    DrawingOption{"--stages", 1, "DIR", "Folder that [output] stages names: pictures of them too", true, true},
    DrawingOption{"--dpi", 1, "N", "Dots per inch", true, true}};

/// One of them, as it was given.
struct GivenDrawingOption {
  DrawingOption const* option;
  std::vector<std::string> values;
};

}  // namespace gridmorph::cli
