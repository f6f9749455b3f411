// One file of an OpenFOAM mesh (polyMesh): header, lists, dictionaries; as text or binary, packed by gzip or not.
// Internal to io.
//
// Format: OpenFOAM User Guide, "File format" and "Mesh description". Lists stand as N(...), N{value} where all values
// are alike, in binary files N(bytes); lists of faces in binary files as two lists, places and nodes (faceCompactList).
#pragma once

#include <gridmorph/core/csr_graph.hpp>
#include <gridmorph/core/index.hpp>
#include <gridmorph/mesh/mesh.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace gridmorph::foam {

/// Where the three numbers of a point stand in the text of a file, or its bytes.
struct PointText {
  Index point = 0;
  int component = 0;
  std::size_t begin = 0, end = 0;
  double value = 0;
};

/// A patch of polyMesh/boundary: its keys with their values as text.
struct BoundaryEntry {
  std::string name;
  std::vector<std::pair<std::string, std::string>> keys;
  int line = 0;
  Index start = 0, size = 0;  ///< its faces: startFace, nFaces

  /// Value of a key; empty where it has none.
  [[nodiscard]] std::string_view operator[](std::string_view key) const;
};

/// An entry of polyMesh/cellZones or faceZones.
struct ZoneEntry {
  std::string name;
  std::vector<Index32> labels;
};

class FoamFile {
 public:
  /// Reads a file, or the packed one of that name with ".gz". Throws IoError when neither is there, for a file without
  /// the header of OpenFOAM, and for one of another class than `classes` names ("labelList", ...).
  FoamFile(std::string const& path, std::vector<std::string_view> const& classes);

  [[nodiscard]] std::string const& path() const { return path_; }  ///< with ".gz" where that is what was read
  [[nodiscard]] std::string const& text() const { return text_; }  ///< unpacked
  [[nodiscard]] bool is_packed() const { return packed_; }
  [[nodiscard]] bool is_binary() const { return binary_; }
  [[nodiscard]] int scalar_bytes() const { return scalar_bytes_; }

  // What follows the header, from its start each time; each throws IoError with the line (text) or the byte (binary)
  // where it is not what it has to be.
  /// Reads a list of labels. `most`: how many there can be. Those below `least` are errors.
  std::vector<Index32> labels(Index most, std::int64_t least = -1);
  CsrGraph faces();
  /// Calls visit for each number, in order. Returns the number of points.
  Index points(std::function<void(PointText const&)> const& visit);
  /// Reads all points.
  Coordinates coordinates();
  /// Reads the patches. Throws MeshError, too, that lists those which do not have their faces among the n_faces of the
  /// mesh.
  std::vector<BoundaryEntry> boundary(Index n_faces);
  /// Reads zones with their `key` ("cellLabels", "faceLabels"), each of 0 ... n - 1; other lists are passed over.
  /// Throws MeshError for labels that are not.
  std::vector<ZoneEntry> zones(std::string_view key, Index n);

 private:
  void find_faces(std::vector<BoundaryEntry>& entries, Index n_faces) const;
  void read_header(std::vector<std::string_view> const& classes);
  void skip_blanks();
  [[nodiscard]] char peek();
  void expect(char wanted, char const* after);
  [[nodiscard]] std::string word();
  [[nodiscard]] std::string value_of_key();
  std::int64_t integer(char const* what);
  double number(std::size_t& begin, std::size_t& end);
  /// Length of a list and its opening bracket. `most_alike`: values that may stand as one, N{value}, which takes no
  /// room in the file.
  Index begin_list(char const* what, Index least_bytes, Index most_alike, char& bracket);
  [[nodiscard]] std::int64_t raw_label();
  std::vector<std::int64_t> raw_list(char const* what, Index most_alike);
  /// A list of `bytes` per value in binary files, of words in others.
  void pass_list(char const* what, int bytes);
  [[noreturn]] void fail(std::string const& what) const;

  std::string path_, text_;
  std::string class_;
  std::size_t at_ = 0, body_ = 0;  ///< what is read next, what follows the header
  bool packed_ = false, binary_ = false;
  int label_bytes_ = 4, scalar_bytes_ = 8;
};

/// The bytes packed as gzip does. Throws IoError where gridmorph is built without zlib.
std::string packed(std::string const& path, std::string const& bytes);

/// Whether the file is there, packed or not.
bool is_there(std::string const& path);

}  // namespace gridmorph::foam
