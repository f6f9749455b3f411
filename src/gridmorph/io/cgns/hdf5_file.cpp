// Objects are described with the calls of HDF5 1.10, which later versions keep.
#define H5_USE_110_API
#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns/hdf5_file.hpp>
#include <gridmorph/io/files_read.hpp>

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace gridmorph::cgns {

namespace {

/// Owner of an HDF5 identifier.
class Id {
 public:
  Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Id() {
    if (id_ >= 0) close_(id_);
  }
  Id(Id const&) = delete;
  Id& operator=(Id const&) = delete;
  [[nodiscard]] hid_t get() const { return id_; }
  explicit operator bool() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// Names of what CGNS keeps in the group of a node.
constexpr char const* data_name = " data";
constexpr char const* link_name = " link";
constexpr char const* old_version_name = " version";
/// Lengths of the library's buffers, the zero at the end included.
constexpr std::size_t name_length = 33, type_length = 3;
/// The depth at which reading stops, deeper than any mesh file nests (families may nest freely).
constexpr int max_depth = 24;
constexpr int max_rank = 12;
/// Links that may lead to one node: some files have one grid for a thousand zones. Links to links multiply.
constexpr int most_links_to_a_node = 4096;
/// Compressed arrays are longer than the file; deflate makes nothing smaller than 1/1032 (zlib's technical details),
/// and a Cartesian mesh comes near that.
constexpr std::uint64_t most_expansion = 1100, always_allowed = 16u << 20;
constexpr std::uint64_t external_files_message = std::uint64_t(1) << 7;  // H5O_EFL_ID

/// HDF5's type in memory for CGNS' names of types; -1 for others.
hid_t memory_type(std::string const& type) {
  if (type == "R8") return H5T_NATIVE_DOUBLE;
  if (type == "R4") return H5T_NATIVE_FLOAT;
  if (type == "I4") return H5T_NATIVE_INT32;
  if (type == "I8") return H5T_NATIVE_INT64;
  if (type == "U4") return H5T_NATIVE_UINT32;
  if (type == "U8") return H5T_NATIVE_UINT64;
  if (type == "C1" || type == "I1") return H5T_NATIVE_CHAR;
  if (type == "B1" || type == "U1") return H5T_NATIVE_UCHAR;
  return -1;
}

/// CGNS' name of the type that an array has in the file; "other" where it has none.
std::string stored_type(hid_t data) {
  Id const type(H5Dget_type(data), H5Tclose);
  auto const kind = H5Tget_class(type.get());
  auto const size = H5Tget_size(type.get());
  if (kind == H5T_FLOAT && (size == 4 || size == 8)) return size == 4 ? "R4" : "R8";
  if (kind == H5T_INTEGER && (size == 4 || size == 8))
    return (H5Tget_sign(type.get()) == H5T_SGN_NONE ? "U" : "I") + std::to_string(size);
  return "other";
}

struct Listed {
  std::string name;
  bool hard = true;
};

herr_t list_one(hid_t, char const* name, H5L_info_t const* info, void* out) {
  if (name[0] != ' ') static_cast<std::vector<Listed>*>(out)->push_back({name, info->type == H5L_TYPE_HARD});
  return 0;
}

std::string data_place(Node const& node) { return node.stored->place + "/" + data_name; }

}  // namespace

/// One pass over the nodes of a file, whole or part.
class Hdf5File::Walk {
 public:
  explicit Walk(Hdf5File const& file) : file_(file) {
    files_.insert(file.path_);
    Id const root(H5Gopen2(file.file_, "/", H5P_DEFAULT), H5Gclose);
    Id const plan(H5Gget_create_plist(root.get()), H5Pclose);
    unsigned flags = 0;
    if (plan && H5Pget_link_creation_order(plan.get(), &flags) >= 0 && flags != 0) order_ = H5_INDEX_CRT_ORDER;
    // Files of CGNS 2 have their dimensions the other way round.
    swapped_ = H5Lexists(file.file_, old_version_name, H5P_DEFAULT) <= 0;
  }

  Node tree(bool (*entered)(Node const&, Node const&)) {
    entered_ = entered;
    Node root;
    root.stored.emplace();
    Id const group(H5Gopen2(file_.file_, "/", H5P_DEFAULT), H5Gclose);
    if (!group) damaged("/", "cannot be read");
    for (auto const& [name, length] : {std::pair{"name", name_length}, {"label", name_length}, {"type", type_length}})
      static_cast<void>(attribute(group.get(), name, length, "/"));
    ancestors_.push_back(identity(group.get(), "/").object);
    seen_.insert(ancestors_.back());
    enter(root, group.get());
    return root;
  }

  void children(Node& node) {
    Id const group(H5Gopen2(file_.file_, node.stored->place.c_str(), H5P_DEFAULT), H5Gclose);
    if (!group) damaged(node.path, "cannot be opened");
    enter(node, group.get());
  }

 private:
  using Object = std::pair<unsigned long, std::uint64_t>;  ///< file and address
  struct Identity {
    Object object;
    unsigned links = 1;
    bool external = false;
  };

  [[noreturn]] void damaged(std::string const& path, std::string const& what) const {
    throw IoError(file_.path_ + ", node " + path + ": " + what +
                  "; the file is damaged or not CGNS: get a fresh copy of it");
  }

  Identity identity(hid_t object, std::string const& path) const {
    H5O_info_t info;
    if (H5Oget_info2(object, &info, H5O_INFO_BASIC | H5O_INFO_HDR) < 0) damaged(path, "cannot be read");
    return {{info.fileno, info.addr}, info.rc, (info.hdr.mesg.present & external_files_message) != 0};
  }

  /// Text of an attribute; nothing where there is none. The library would read it into a buffer of `length`.
  std::optional<std::string> attribute(hid_t object, char const* name, std::size_t length,
                                       std::string const& path) const {
    Id const attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
    if (!attribute) return std::nullopt;
    Id const type(H5Aget_type(attribute.get()), H5Tclose);
    Id const space(H5Aget_space(attribute.get()), H5Sclose);
    if (!type || !space) damaged(path, std::string("its attribute '") + name + "' cannot be read");
    auto const kind = H5Tget_class(type.get());
    auto const size = H5Tget_size(type.get());
    auto const count = H5Sget_simple_extent_npoints(space.get());
    bool const text = (kind == H5T_STRING && H5Tis_variable_str(type.get()) == 0) || (kind == H5T_INTEGER && size == 1);
    if (!text) damaged(path, std::string("its attribute '") + name + "' is no text of fixed length");
    if (count < 1 || std::uint64_t(count) > length || size < 1 || size > length || size * std::size_t(count) > length)
      damaged(path, std::string("its attribute '") + name + "' is longer than CGNS allows (" + std::to_string(size) +
                        " x " + std::to_string(count) + " characters, at most " + std::to_string(length) + ")");
    std::array<char, name_length + 1> buffer{};
    if (H5Aread(attribute.get(), type.get(), buffer.data()) < 0)
      damaged(path, std::string("its attribute '") + name + "' cannot be read");
    return std::string(buffer.data());
  }

  /// Label and type of a node; the attribute of its name is only looked at.
  void describe(hid_t object, Node& node) const {
    static_cast<void>(attribute(object, "name", name_length, node.path));
    auto const label = attribute(object, "label", name_length, node.path);
    auto const type = attribute(object, "type", type_length, node.path);
    if (!label || !type) damaged(node.path, std::string("lacks its attribute '") + (label ? "type" : "label") + "'");
    node.label = *label;
    node.stored->type = *type;
  }

  void enter(Node& node, hid_t group) {
    std::vector<Listed> names;
    if (H5Literate(group, order_, H5_ITER_INC, nullptr, list_one, &names) < 0) {
      names.clear();
      if (H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, list_one, &names) < 0)
        damaged(node.path, "its children cannot be listed");
    }
    node.children.reserve(names.size());
    for (auto& listed : names) add(node, group, listed);
  }

  void add(Node& node, hid_t group, Listed& listed) {
    Id object(H5Oopen(group, listed.name.c_str(), H5P_DEFAULT), H5Oclose);
    Node child;
    child.path = node.path + "/" + listed.name;
    child.linked = node.linked || !listed.hard;
    child.stored.emplace();
    child.stored->place = node.stored->place + "/" + listed.name;
    child.name = std::move(listed.name);
    if (object && !listed.hard) child.file = note_file(object.get());
    if (!object) {
      if (listed.hard) damaged(child.path, "cannot be opened");
      child.stored->type = "MT";
      node.children.push_back(std::move(child));
      return;
    }
    if (H5Iget_type(object.get()) != H5I_GROUP) return;  // nothing of CGNS'
    describe(object.get(), child);
    if (child.stored->type != "LK") return finish(node, std::move(child), object.get(), listed.hard && !node.linked);
    child.linked = true;
    child.label.clear();
    child.stored->type = "MT";
    Id const target(H5Oopen(object.get(), link_name, H5P_DEFAULT), H5Oclose);
    // A link to a file that is not there only matters if the mesh needs what it would lead to: such a node stays in the
    // tree without a label.
    if (!target || H5Iget_type(target.get()) != H5I_GROUP) {
      node.children.push_back(std::move(child));
      return;
    }
    child.stored->place += std::string("/") + link_name;
    child.file = note_file(target.get());
    describe(target.get(), child);
    if (child.stored->type == "LK") damaged(child.path, "is a link to a link");
    finish(node, std::move(child), target.get(), false);
  }

  void finish(Node& node, Node child, hid_t object, bool hard) {
    Object const own = identity(object, child.path).object;
    if (std::find(ancestors_.begin(), ancestors_.end(), own) != ancestors_.end())
      damaged(child.path, "is a link that leads back to a node above it");
    if (hard && !seen_.insert(own).second && entered_ != nullptr)
      damaged(child.path, "is listed twice: its group has another name in the file");
    if (!hard && ++linked_[own] > most_links_to_a_node)
      damaged(child.path, "more than " + std::to_string(most_links_to_a_node) + " links lead to the same node");
    if (child.stored->type != "MT") describe_data(object, node, child);
    if (entered_ != nullptr && entered_(child, node)) {
      if (ancestors_.size() >= max_depth) damaged(child.path, "nodes are nested too deep");
      ancestors_.push_back(own);
      enter(child, object);
      ancestors_.pop_back();
    }
    node.children.push_back(std::move(child));
  }

  void describe_data(hid_t object, Node const& above, Node& node) {
    if (H5Lexists(object, data_name, H5P_DEFAULT) <= 0) return;
    H5L_info_t link;
    if (H5Lget_info(object, data_name, &link, H5P_DEFAULT) < 0) damaged(node.path, "its data cannot be found");
    bool const coordinates = above.label == "GridCoordinates_t";
    Id const data(H5Dopen2(object, data_name, H5P_DEFAULT), H5Dclose);
    if (!data) damaged(node.path, "its data cannot be opened");
    auto& stored = *node.stored;
    Id const space(H5Dget_space(data.get()), H5Sclose);
    std::array<hsize_t, H5S_MAX_RANK> sizes{};
    int const rank = space ? H5Sget_simple_extent_dims(space.get(), sizes.data(), nullptr) : -1;
    if (rank < 0 || rank > max_rank) damaged(node.path, "its data have no dimensions that CGNS knows");
    std::uint64_t bytes = rank == 0 ? 0 : std::uint64_t(bytes_per_element(stored.type));
    for (int a = 0; a < rank; ++a) {
      std::uint64_t const n = sizes[a];
      if (n > std::uint64_t(std::numeric_limits<std::int64_t>::max()) / std::max<std::uint64_t>(bytes, 1))
        too_large(node);
      bytes *= n;
      stored.dimensions.push_back(Index(n));
    }
    if (swapped_) std::reverse(stored.dimensions.begin(), stored.dimensions.end());
    auto const own = identity(data.get(), node.path);
    stored.object = own.object;
    stored.shared = own.links > 1 || link.type == H5L_TYPE_SOFT;
    if (link.type != H5L_TYPE_HARD) node.file = note_file(data.get());
    if (coordinates && link.type != H5L_TYPE_HARD && !node.file.empty())
      throw IoError(file_.path_ + ", node " + node.path + ": its data are in another file ('" + node.file +
                    "', an external link), which must not be changed; write them into this file first, for instance "
                    "with h5copy -f ext");
    if (own.external || ((coordinates || bytes > Stored::small) && is_virtual(data.get())))
      throw IoError(file_.path_ + ", node " + node.path +
                    ": its data are in another file (external storage), which must not be changed; write them into "
                    "this file first, for instance with h5repack -l CONTI");
    if (coordinates) stored.type_in_file = stored_type(data.get());
    declared_ += bytes;
    if (declared_ > always_allowed + most_expansion * bytes_of_files()) too_large(node);
    hid_t const type = memory_type(stored.type);
    if (coordinates || bytes == 0 || bytes > Stored::small || type < 0) return;
    stored.bytes.resize(bytes);
    if (H5Dread(data.get(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, stored.bytes.data()) < 0)
      damaged(node.path, "its data cannot be read");
  }

  /// Whether an array is put together from others. Arrays in one piece, which have an address, are not asked: that
  /// takes time.
  static bool is_virtual(hid_t data) {
    if (H5Dget_offset(data) != HADDR_UNDEF) return false;
    Id const how(H5Dget_create_plist(data), H5Pclose);
    return how && H5Pget_layout(how.get()) == H5D_VIRTUAL;
  }

  [[noreturn]] void too_large(Node const& node) const {
    throw IoError(
        file_.path_ + ", node " + node.path +
        ": the arrays up to here declare more data than the file can hold, or are compressed to less than 1/" +
        std::to_string(most_expansion) +
        " of their size; if the file is sound, write it without compression (h5repack -f NONE)");
  }

  /// The file that a link leads to, when it is another one.
  std::string note_file(hid_t object) {
    std::string name(std::size_t(std::max<ssize_t>(0, H5Fget_name(object, nullptr, 0))) + 1, '\0');
    if (H5Fget_name(object, name.data(), name.size()) < 0) return {};
    name.pop_back();
    if (name == file_.path_) return {};
    if (!files_.insert(name).second) return name;
    io::FilesRead::note(name);
    std::error_code failure;
    auto const size = std::filesystem::file_size(name, failure);
    if (!failure) bytes_of_links_ += size;
    return name;
  }
  [[nodiscard]] std::uint64_t bytes_of_files() {
    if (bytes_ == 0) {
      std::error_code failure;
      auto const size = std::filesystem::file_size(file_.path_, failure);
      bytes_ = failure ? 0 : size;
    }
    return bytes_ + bytes_of_links_;
  }

  Hdf5File const& file_;
  H5_index_t order_ = H5_INDEX_NAME;
  bool swapped_ = true;
  bool (*entered_)(Node const&, Node const&) = nullptr;
  std::vector<Object> ancestors_;
  std::set<Object> seen_;
  std::set<std::string> files_;
  std::map<Object, int> linked_;
  std::uint64_t declared_ = 0, bytes_ = 0, bytes_of_links_ = 0;
};

Hdf5File::Hdf5File(std::string path) : path_(std::move(path)) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are told by exceptions
  file_ = H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file_ < 0)
    throw IoError(path_ +
                  ": cannot be opened as HDF5; the file is damaged, cut short or in use: get a fresh copy of it");
}

Hdf5File::~Hdf5File() {
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5File::check_for_library() const {
  if (H5Lexists(file_, old_version_name, H5P_DEFAULT) > 0)
    static_cast<void>(tree([](Node const&, Node const&) { return true; }));
}

Node Hdf5File::tree(bool (*entered)(Node const&, Node const&)) const { return Walk(*this).tree(entered); }

void Hdf5File::load_children(Node& node) const {
  node.children.clear();
  Walk(*this).children(node);
}

void Hdf5File::read(Node const& node, std::string const& type, void* data) const {
  hid_t const memory = memory_type(type);
  Id const from(H5Dopen2(file_, data_place(node).c_str(), H5P_DEFAULT), H5Dclose);
  if (memory < 0 || !from || H5Dread(from.get(), memory, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0)
    throw IoError(path_ + ", node " + node.path +
                  ": its data cannot be read; the file is damaged or not CGNS: get a fresh copy of it");
}

}  // namespace gridmorph::cgns
