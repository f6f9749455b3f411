#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns/cgns_file.hpp>
#include <gridmorph/io/cgns/hdf5_file.hpp>
#include <gridmorph/io/file_check.hpp>
#include <gridmorph/io/files_read.hpp>

#include <cgns_io.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <limits>
#include <mutex>

#include <sys/stat.h>

namespace gridmorph::cgns {

namespace {

/// Node labels whose children matter to a mesh, or are taken out of it. Everything else (solutions, data sets,
/// sections) is not entered.
bool holds_mesh(std::string const& label) {
  static constexpr std::string_view entered[] = {"CGNSBase_t",
                                                 "Zone_t",
                                                 "GridCoordinates_t",
                                                 "Elements_t",
                                                 "Family_t",
                                                 "ZoneBC_t",
                                                 "BC_t",
                                                 "ZoneGridConnectivity_t",
                                                 "GridConnectivity1to1_t",
                                                 "GridConnectivity_t",
                                                 "GridConnectivityProperty_t",
                                                 "Periodic_t",
                                                 "BaseIterativeData_t",
                                                 "ZoneIterativeData_t"};
  return std::find(std::begin(entered), std::end(entered), label) != std::end(entered);
}

/// The depth at which reading stops, deeper than any mesh file nests (families may nest freely): stops at links that
/// lead back up.
constexpr int max_depth = 24;
/// HDF5 arrays may be compressed, so that they are longer than the file; beyond this ratio the length is not believed.
constexpr Index max_compression = 1100;

/// Nodes that links of an ADF file may lead to.
constexpr std::size_t most_linked_nodes = 300'000;

/// Arrays of Periodic_t may carry units of their own.
bool is_entered(Node const& node, Node const& above) { return holds_mesh(node.label) || above.label == "Periodic_t"; }

/// The tree that was read last: commands open a mesh several times, and files of thousands of zones take seconds each
/// time.
struct LastTree {
  struct stat file {};
  Node tree;
};
std::mutex last_tree_access;
std::optional<LastTree> last_tree;

bool same_moment(timespec const& a, timespec const& b) { return a.tv_sec == b.tv_sec && a.tv_nsec == b.tv_nsec; }

bool same_file(struct stat const& a, struct stat const& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino && a.st_size == b.st_size && same_moment(a.st_mtim, b.st_mtim) &&
         same_moment(a.st_ctim, b.st_ctim);
}

/// Times of files are coarse: one that changed just now could change again unseen.
bool is_at_rest(struct stat const& file) { return std::time(nullptr) > file.st_ctim.tv_sec + 2; }

/// The file that a link leads to; empty where it is this one or not there.
std::string linked_file(int handle, std::string const& path, double id) {
  int file_length = 0, name_length = 0;
  if (cgio_link_size(handle, id, &file_length, &name_length) != CGIO_ERR_NONE || file_length <= 0) return {};
  std::string file(std::size_t(file_length) + 1, '\0'), name(std::size_t(std::max(name_length, 0)) + 1, '\0');
  if (cgio_get_link(handle, id, file.data(), name.data()) != CGIO_ERR_NONE) return {};
  std::array<char, CGIO_MAX_FILE_LENGTH + 1> found{};
  return cgio_find_file(path.c_str(), file.c_str(), CGIO_FILE_NONE, int(found.size()), found.data()) == CGIO_ERR_NONE
             ? found.data()
             : std::string();
}

template <class Held, class Value>
std::vector<Value> read_as(File const& file, Node const& node, std::string const& type, Index n) {
  std::vector<Held> stored(static_cast<std::size_t>(n));
  file.read(node, type, stored.data());
  return {stored.begin(), stored.end()};
}

}  // namespace

int bytes_per_element(std::string const& type) {
  if (type == "C1" || type == "B1" || type == "U1" || type == "I1") return 1;
  if (type == "I4" || type == "U4" || type == "R4") return 4;
  if (type == "I8" || type == "U8" || type == "R8") return 8;
  return 0;
}

Node const* Node::child(std::string_view wanted) const {
  auto const found = std::find_if(children.begin(), children.end(), [&](Node const& n) { return n.name == wanted; });
  return found == children.end() ? nullptr : &*found;
}

Node const* Node::labelled(std::string_view wanted) const {
  auto const found = std::find_if(children.begin(), children.end(), [&](Node const& n) { return n.label == wanted; });
  return found == children.end() ? nullptr : &*found;
}

std::vector<Node const*> Node::all(std::string_view wanted) const {
  std::vector<Node const*> out;
  for (auto const& n : children)
    if (n.label == wanted) out.push_back(&n);
  return out;
}

File::File(std::string path, Mode mode, FileFormat format) : path_(std::move(path)), mode_(mode), format_(format) {
  if (mode != Mode::create) {
    format_ = check_file(path_);
    io::FilesRead::note(path_);
    file_size_ = Index(std::filesystem::file_size(path_));
  }
  if (mode != Mode::create && format_ == FileFormat::cgns_hdf5)
    hdf5_ = std::make_unique<Hdf5File>(path_);
  else
    open_library();
}

void File::open_library() {
  if (handle_ != 0) return;
  if (hdf5_) hdf5_->check_for_library();
  hdf5_.reset();
  int const cgio_mode = mode_ == Mode::read     ? CGIO_MODE_READ
                        : mode_ == Mode::modify ? CGIO_MODE_MODIFY
                                                : CGIO_MODE_WRITE;
  int const type = format_ == FileFormat::cgns_hdf5 ? CGIO_FILE_HDF5 : CGIO_FILE_ADF;
  cgio_error_abort(0);
  errno = 0;
  int const status = cgio_open_file(path_.c_str(), cgio_mode, type, &handle_);
  if (status != CGIO_ERR_NONE) handle_ = 0;
  check(status, mode_ == Mode::create ? "created" : "opened", "");
}

Hdf5File const& File::reader() const {
  if (!hdf5_) throw IoError(path_ + ": is being written; its tree cannot be read before it is closed");
  return *hdf5_;
}

File::~File() {
  if (handle_ != 0) cgio_close_file(handle_);
}

void File::check(int status, std::string const& doing, std::string const& node_path) const {
  if (status == CGIO_ERR_NONE) return;
  int const system_error = errno;
  char reason[CGIO_MAX_ERROR_LENGTH + 1] = "";
  cgio_error_message(reason);
  std::string const what =
      path_ + (node_path.empty() ? "" : ", node " + node_path) + ": cannot be " + doing + ": " + reason;
  if (mode_ == Mode::read) throw IoError(what + "; the file is damaged or not CGNS: get a fresh copy of it");
  throw MachineError(what +
                     (system_error != 0 ? std::string(" (") + std::strerror(system_error) + ")" : std::string()) +
                     "; check space and permissions");
}

double File::root() {
  open_library();
  double id = 0;
  check(cgio_get_root_id(handle_, &id), "read", "/");
  return id;
}

double File::id(Node const& node) {
  if (!node.stored) return node.id;
  double const root = this->root();
  if (node.path.empty()) return root;
  double id = 0;
  check(cgio_get_node_id(handle_, root, node.path.c_str(), &id), "found", node.path);
  return id;
}

Node File::tree() const {
  if (format_ == FileFormat::cgns_hdf5) {
    struct stat own {};
    bool const known = mode_ == Mode::read && ::stat(path_.c_str(), &own) == 0;
    std::lock_guard const lock(last_tree_access);
    if (known && last_tree && same_file(last_tree->file, own)) return last_tree->tree;
    Node tree = reader().tree(is_entered);
    if (known && is_at_rest(own)) last_tree = LastTree{own, tree};
    return tree;
  }
  Node root;
  check(cgio_get_root_id(handle_, &root.id), "read", "/");
  linked_nodes_ = 0;
  load_children(root, 0);
  return root;
}

Node File::tree_of_copy(Node const& original) const { return original.stored ? original : tree(); }

void File::load_children(Node& node) const {
  node.children.clear();
  if (node.stored) return reader().load_children(node);
  load_children(node, max_depth - 1);
}

void File::load_children(Node& node, int depth) const {
  int count = 0;
  check(cgio_number_children(handle_, node.id, &count), "listed", node.path);
  if (count <= 0 || depth >= max_depth) return;
  std::vector<double> ids(static_cast<std::size_t>(count));
  int found = 0;
  check(cgio_children_ids(handle_, node.id, 1, count, &found, ids.data()), "listed", node.path);
  ids.resize(static_cast<std::size_t>(std::clamp(found, 0, count)));
  node.children.reserve(ids.size());
  for (double const id : ids) {
    Node child;
    child.id = id;
    char name[CGIO_MAX_NAME_LENGTH + 1] = "";
    check(cgio_get_name(handle_, id, name), "listed", node.path);
    child.name = name;
    child.path = node.path + "/" + child.name;
    int link_length = 0;
    check(cgio_is_link(handle_, id, &link_length), "read", child.path);
    child.linked = node.linked || link_length > 0;
    if (link_length > 0) child.file = linked_file(handle_, path_, id);
    if (!child.file.empty()) io::FilesRead::note(child.file);
    if (child.linked && ++linked_nodes_ > most_linked_nodes)
      throw IoError(path_ + ", node " + child.path + ": links lead to more than " + std::to_string(most_linked_nodes) +
                    " nodes, perhaps in a circle; the file is damaged: get a fresh copy of it");
    char label[CGIO_MAX_LABEL_LENGTH + 1] = "";
    // A link to a file that is not there only matters if the mesh needs what it would lead to: such a node stays in
    // the tree without a label.
    int const status = cgio_get_label(handle_, id, label);
    if (!child.linked) check(status, "read", child.path);
    if (status == CGIO_ERR_NONE) child.label = label;
    if (is_entered(child, node)) load_children(child, depth + 1);
    node.children.push_back(std::move(child));
  }
}

std::string File::type(Node const& node) const {
  if (node.stored) return node.stored->type;
  char type[CGIO_MAX_DATATYPE_LENGTH + 1] = "";
  check(cgio_get_data_type(handle_, node.id, type), "read", node.path);
  return type;
}

std::vector<Index> File::dimensions(Node const& node) const {
  if (node.stored) return node.stored->dimensions;
  int rank = 0;
  cgsize_t sizes[CGIO_MAX_DIMENSIONS] = {};
  check(cgio_get_dimensions(handle_, node.id, &rank, sizes), "read", node.path);
  return {sizes, sizes + std::clamp(rank, 0, CGIO_MAX_DIMENSIONS)};
}

Index File::count(Node const& node) const {
  std::string const stored_as = type(node);
  auto const sizes = dimensions(node);
  if (sizes.empty() || stored_as == "MT") return 0;
  // Arrays in HDF5 files have been compared with the files when the tree was read.
  Index const most =
      node.stored ? std::numeric_limits<Index>::max() / 8
                  : max_compression * std::max<Index>(file_size_, 4096) / std::max(1, bytes_per_element(stored_as));
  Index n = 1;
  for (Index const size : sizes) {
    if (size < 0 || (size > 0 && n > most / size))
      throw IoError(path_ + ", node " + node.path + ": declares more data than the file can hold; the file is damaged");
    n *= size;
  }
  return n;
}

void File::read(Node const& node, std::string const& type, void* data) const {
  if (node.stored && !node.stored->bytes.empty() && type == node.stored->type) {
    std::memcpy(data, node.stored->bytes.data(), node.stored->bytes.size());
    return;
  }
  if (hdf5_) return hdf5_->read(node, type, data);
  double id = node.id;
  if (node.stored) {
    double root = 0;
    check(cgio_get_root_id(handle_, &root), "read", "/");
    check(cgio_get_node_id(handle_, root, node.path.c_str(), &id), "found", node.path);
  }
  check(cgio_read_all_data_type(handle_, id, type.c_str(), data), "read", node.path);
}

std::string File::characters(Node const& node) const {
  std::string const stored_as = type(node);
  if (stored_as == "MT") return "";
  if (stored_as != "C1") throw IoError(path_ + ", node " + node.path + ": expected text (C1), found type " + stored_as);
  std::string out(static_cast<std::size_t>(count(node)), '\0');
  if (!out.empty()) read(node, stored_as, out.data());
  return out;
}

std::string File::text(Node const& node) const {
  std::string out = characters(node);
  out.resize(std::min(out.find('\0'), out.size()));
  auto const last = out.find_last_not_of(" \t\r\n");
  out.resize(last == std::string::npos ? 0 : last + 1);
  return out;
}

std::vector<std::int64_t> File::integers(Node const& node) const {
  std::string const stored_as = type(node);
  Index const n = count(node);
  if (n == 0) return {};
  if (stored_as == "I4") return read_as<std::int32_t, std::int64_t>(*this, node, stored_as, n);
  if (stored_as == "U4") return read_as<std::uint32_t, std::int64_t>(*this, node, stored_as, n);
  if (stored_as == "I8" || stored_as == "U8") return read_as<std::int64_t, std::int64_t>(*this, node, stored_as, n);
  throw IoError(path_ + ", node " + node.path + ": expected integers (I4 or I8), found type " + stored_as);
}

std::vector<double> File::reals(Node const& node) const {
  std::string const stored_as = type(node);
  Index const n = count(node);
  if (n == 0) return {};
  if (stored_as == "R4") return read_as<float, double>(*this, node, stored_as, n);
  if (stored_as == "R8") return read_as<double, double>(*this, node, stored_as, n);
  if (stored_as == "I4" || stored_as == "I8") {
    auto const whole = integers(node);
    return {whole.begin(), whole.end()};
  }
  throw IoError(path_ + ", node " + node.path + ": expected numbers (R4 or R8), found type " + stored_as);
}

void File::write(Node const& node, void const* data) {
  errno = 0;
  double const place = id(node);
  check(cgio_write_all_data(handle_, place, data), "written", node.path);
}

double File::create(double parent, std::string const& name, std::string const& label, std::string const& type,
                    std::vector<Index> const& dimensions, void const* data) {
  if (name.empty() || name.size() > CGIO_MAX_NAME_LENGTH || name.find('/') != std::string::npos)
    throw IoError(path_ + ": '" + name + "' cannot name a " + label +
                  " node: CGNS names have 1 to 32 characters without '/'");
  std::vector<cgsize_t> sizes;
  for (Index const size : dimensions) {
    if (size > std::numeric_limits<cgsize_t>::max())
      throw IoError(path_ + ", node " + name + ": is too long for a CGNS library built with 32-bit sizes");
    sizes.push_back(cgsize_t(size));
  }
  double id = 0;
  errno = 0;
  check(cgio_new_node(handle_, parent, name.c_str(), label.c_str(), type.c_str(), int(sizes.size()), sizes.data(), data,
                      &id),
        "written", name);
  return id;
}

double File::create_text(double parent, std::string const& name, std::string const& label, std::string const& text) {
  return create(parent, name, label, "C1", {Index(text.size())}, text.data());
}

void File::remove(Node const& parent, Node const& node) {
  errno = 0;
  double const above = id(parent), place = id(node);
  check(cgio_delete_node(handle_, above, place), "removed", node.path);
}

void File::close() {
  if (handle_ == 0) return;
  int const handle = handle_;
  errno = 0;
  if (mode_ != Mode::read) check(cgio_flush_to_disk(handle), "written", "");
  handle_ = 0;
  check(cgio_close_file(handle), "closed", "");
}

}  // namespace gridmorph::cgns
