// Names of a mesh as people can be shown them. Internal to io.
#pragma once

#include <gridmorph/mesh/mesh.hpp>

namespace gridmorph::io {

/// Control characters in names of patches, families, connections and subsets become '?', with a note: on a terminal a
/// line feed in a name would begin a line of its own that looks like one of ours. Throws IoError for zones named so,
/// which writers find by their name.
void make_names_printable(Mesh& mesh);

}  // namespace gridmorph::io
