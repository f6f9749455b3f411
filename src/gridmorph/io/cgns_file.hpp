// A CGNS file as a tree of nodes. Thin owner of the CGNS library's low-level file handle (cgio), which treats HDF5 and
// ADF files alike and, unlike the mid-level library, neither interprets nor rewrites nodes it was not asked about.
#pragma once

#include <gridmorph/core/index.hpp>
#include <gridmorph/io/mesh_io.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::cgns {

struct Node {
  std::string name;
  std::string label;
  std::string path;     ///< "/Base/Zone 1/ZoneBC", for messages
  double id = 0;        ///< the library's handle
  bool linked = false;  ///< this node or one above it lives in another place than it is listed
  std::vector<Node> children;

  [[nodiscard]] Node const* child(std::string_view name) const;      ///< nullptr if there is none
  [[nodiscard]] Node const* labelled(std::string_view label) const;  ///< the first; nullptr if there is none
  [[nodiscard]] std::vector<Node const*> all(std::string_view label) const;
};

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
  [[nodiscard]] double root() const;

  /// The nodes that describe a mesh, without their data. Solutions, sections and the like are listed, not entered.
  [[nodiscard]] Node tree() const;
  /// Enters a node that tree() only lists: its children, without theirs.
  void load_children(Node& node) const;

  /// "R8", "I4", "C1", "MT", ...
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
  void load_children(Node& node, int depth) const;

  std::string path_;
  Mode mode_;
  int handle_ = 0;
  Index file_size_ = 0;
};

}  // namespace gridmorph::cgns
