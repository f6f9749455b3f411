// CGNS files in HDF5, read with HDF5 itself. Internal to io.
//
// The CGNS library copies attributes into buffers of fixed size without looking at their length, follows links that
// lead back up, and reads every attribute anew on each question. Here all of that is looked at once, before the library
// opens such a file to write.
#pragma once

#include <gridmorph/io/cgns/cgns_file.hpp>

#include <cstdint>
#include <string>

namespace gridmorph::cgns {

class Hdf5File {
 public:
  /// Opens a file to read. Throws IoError.
  explicit Hdf5File(std::string path);
  ~Hdf5File();
  Hdf5File(Hdf5File const&) = delete;
  Hdf5File& operator=(Hdf5File const&) = delete;

  /// The tree below the root, with Node::stored of every node; `entered` says by label and by that of the node above
  /// whether a node's children are wanted too. Throws IoError for attributes that are no text of CGNS' lengths, links
  /// that lead back up, groups that are listed twice, data in other files (external storage), and arrays that are far
  /// larger than all files together. Cost: some 50 microseconds per node; arrays up to Stored::small bytes are read.
  [[nodiscard]] Node tree(bool (*entered)(Node const& node, Node const& above)) const;
  /// Looks at every node of a file of CGNS 2, as the library does when it opens one to write; others are checked as far
  /// as their tree has been read.
  void check_for_library() const;
  /// The children of one node, without theirs.
  void load_children(Node& node) const;
  /// A whole array as "R8", "R4", "I4", ...
  void read(Node const& node, std::string const& type, void* data) const;

 private:
  class Walk;
  std::string path_;
  std::int64_t file_ = -1;
};

}  // namespace gridmorph::cgns
