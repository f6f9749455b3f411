// A CGNS file as a tree of nodes. Thin owner of the CGNS library's low-level file handle (cgio), which treats HDF5 and
// ADF files alike and, unlike the mid-level library, neither interprets nor rewrites nodes it was not asked about.
#pragma once

#include <gridmorph/core/index.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gridmorph::cgns {

/// Bytes of one value of a type ("R8": 8); 0 for types that hold no numbers or text.
int bytes_per_element(std::string const& type);

/// The place and the data of a node in an HDF5 file.
struct Stored {
  static constexpr std::uint64_t small =
      1024;  ///< arrays of up to so many bytes are read with the tree, but for coordinates

  std::string place;                               ///< its path in HDF5, links followed
  std::string type;                                ///< "R8", "I4", "C1", "MT", ... as the node says
  std::string type_in_file;                        ///< of coordinates: what the array has
  std::vector<Index> dimensions;                   ///< first one fastest
  std::string bytes;                               ///< of a small array, as the type is in memory
  std::pair<unsigned long, std::uint64_t> object;  ///< the array: file and address
  bool shared = false;                             ///< the array has other names in the file
};

struct Node {
  std::string name;
  std::string label;
  std::string path;              ///< "/Base/Zone 1/ZoneBC", for messages
  double id = 0;                 ///< the library's handle; File::id() where there is `stored`
  bool linked = false;           ///< this node or one above it lives in another place than it is listed
  std::string file;              ///< of a link to another file: that file, when it is there
  std::optional<Stored> stored;  ///< in HDF5 files
  std::vector<Node> children;

  [[nodiscard]] Node const* child(std::string_view name) const;      ///< nullptr if there is none
  [[nodiscard]] Node const* labelled(std::string_view label) const;  ///< the first; nullptr if there is none
  [[nodiscard]] std::vector<Node const*> all(std::string_view label) const;
};

class Hdf5File;

class File {
 public:
  enum class Mode { read, modify, create };
  /// Upper bound of what a node without large data takes on disk.
  static constexpr std::uint64_t bytes_per_node = 6144;

  /// Opens a file; read and modify check first that it is a whole CGNS file. `format` matters for create only.
  File(std::string path, Mode mode, FileFormat format = FileFormat::cgns_hdf5);
  ~File();  ///< closes; errors are lost, so call close() after writing
  File(File const&) = delete;
  File& operator=(File const&) = delete;

  [[nodiscard]] std::string const& path() const { return path_; }
  [[nodiscard]] double root();
  /// The library's handle of a node, to write there.
  [[nodiscard]] double id(Node const& node);

  /// The nodes that describe a mesh, without their data. Solutions, sections and the like are listed, not entered.
  [[nodiscard]] Node tree() const;
  /// The tree of a file that is a copy of the one whose tree is given, byte for byte: nothing is read where that is
  /// enough.
  [[nodiscard]] Node tree_of_copy(Node const& original) const;
  /// Enters a node that tree() only lists: its children, without theirs.
  void load_children(Node& node) const;

  /// The data type of a node: "R8", "I4", "C1", "MT", ...
  [[nodiscard]] std::string type(Node const& node) const;
  [[nodiscard]] std::vector<Index> dimensions(Node const& node) const;  ///< first one fastest
  /// Number of values; throws IoError where a damaged file declares more than it can hold.
  [[nodiscard]] Index count(Node const& node) const;
  [[nodiscard]] std::string characters(Node const& node) const;  ///< as they are
  [[nodiscard]] std::string text(Node const& node) const;        ///< up to the first NUL, without blanks at its end
  [[nodiscard]] std::vector<std::int64_t> integers(Node const& node) const;
  [[nodiscard]] std::vector<double> reals(Node const& node) const;  ///< single precision is widened
  /// The whole array as it is stored ("R8" into doubles, "R4" into floats, ...); the caller has checked type and size.
  void read(Node const& node, std::string const& type, void* data) const;

  /// Replaces the whole array of a node; data has the node's own type.
  void write(Node const& node, void const* data);
  /// Adds a node; returns its handle. type "MT": no data.
  double create(double parent, std::string const& name, std::string const& label, std::string const& type = "MT",
                std::vector<Index> const& dimensions = {}, void const* data = nullptr);
  /// Takes a node away with all that is below it.
  void remove(Node const& parent, Node const& node);
  double create_text(double parent, std::string const& name, std::string const& label, std::string const& text);

  /// Flushes and closes; throws MachineError when something did not reach the disk.
  void close();

 private:
  void check(int status, std::string const& doing, std::string const& node_path) const;
  void open_library();
  Hdf5File const& reader() const;
  void load_children(Node& node, int depth) const;

  std::string path_;
  Mode mode_;
  FileFormat format_;
  int handle_ = 0;  ///< of the CGNS library; files in HDF5 have one only while they are written
  Index file_size_ = 0;
  std::unique_ptr<Hdf5File> hdf5_;  ///< of files in HDF5 while they are only read
  mutable std::size_t linked_nodes_ = 0;
};

}  // namespace gridmorph::cgns
