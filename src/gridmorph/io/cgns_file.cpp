#include <gridmorph/core/error.hpp>
#include <gridmorph/io/cgns_file.hpp>
#include <gridmorph/io/file_check.hpp>

#include <cgns_io.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <limits>

namespace gridmorph::cgns {

namespace {

/// Node labels whose children matter to a mesh. Everything else (solutions, data sets, sections) is not entered.
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
                                                 "Periodic_t"};
  return std::find(std::begin(entered), std::end(entered), label) != std::end(entered);
}

/// Deeper than any mesh file nests (families may nest freely): stops at links that lead back up.
constexpr int max_depth = 24;
/// HDF5 arrays may be compressed, so that they are longer than the file; beyond this ratio the length is not believed.
constexpr Index max_compression = 1100;

int bytes_per_element(std::string const& type) {
  if (type == "C1" || type == "B1" || type == "U1" || type == "I1") return 1;
  if (type == "I4" || type == "U4" || type == "R4") return 4;
  if (type == "I8" || type == "U8" || type == "R8") return 8;
  return 0;
}

template <class Stored, class Value>
std::vector<Value> read_as(File const& file, Node const& node, std::string const& type, Index n) {
  std::vector<Stored> stored(static_cast<std::size_t>(n));
  file.read(node, type, stored.data());
  return {stored.begin(), stored.end()};
}

}  // namespace

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

File::File(std::string path, Mode mode, FileFormat format) : path_(std::move(path)), mode_(mode) {
  if (mode != Mode::create) {
    format = check_file(path_);
    file_size_ = Index(std::filesystem::file_size(path_));
  }
  int const cgio_mode = mode == Mode::read ? CGIO_MODE_READ : mode == Mode::modify ? CGIO_MODE_MODIFY : CGIO_MODE_WRITE;
  int const type = format == FileFormat::cgns_hdf5 ? CGIO_FILE_HDF5 : CGIO_FILE_ADF;
  cgio_error_abort(0);
  errno = 0;
  int const status = cgio_open_file(path_.c_str(), cgio_mode, type, &handle_);
  if (status != CGIO_ERR_NONE) handle_ = 0;
  check(status, mode == Mode::create ? "created" : "opened", "");
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

double File::root() const {
  double id = 0;
  check(cgio_get_root_id(handle_, &id), "read", "/");
  return id;
}

Node File::tree() const {
  Node root;
  root.id = this->root();
  load_children(root, 0);
  return root;
}

void File::load_children(Node& node) const {
  node.children.clear();
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
    char label[CGIO_MAX_LABEL_LENGTH + 1] = "";
    // A link to a file that is not there only matters if the mesh needs what it would lead to: such a node stays in
    // the tree without a label.
    int const status = cgio_get_label(handle_, id, label);
    if (!child.linked) check(status, "read", child.path);
    if (status == CGIO_ERR_NONE) child.label = label;
    // Arrays of Periodic_t may carry units of their own.
    if (holds_mesh(child.label) || node.label == "Periodic_t") load_children(child, depth + 1);
    node.children.push_back(std::move(child));
  }
}

std::string File::type(Node const& node) const {
  char type[CGIO_MAX_DATATYPE_LENGTH + 1] = "";
  check(cgio_get_data_type(handle_, node.id, type), "read", node.path);
  return type;
}

std::vector<Index> File::dimensions(Node const& node) const {
  int rank = 0;
  cgsize_t sizes[CGIO_MAX_DIMENSIONS] = {};
  check(cgio_get_dimensions(handle_, node.id, &rank, sizes), "read", node.path);
  return {sizes, sizes + std::clamp(rank, 0, CGIO_MAX_DIMENSIONS)};
}

Index File::count(Node const& node) const {
  std::string const stored_as = type(node);
  auto const sizes = dimensions(node);
  if (sizes.empty() || stored_as == "MT") return 0;
  Index const most = max_compression * std::max<Index>(file_size_, 4096) / std::max(1, bytes_per_element(stored_as));
  Index n = 1;
  for (Index const size : sizes) {
    if (size < 0 || (size > 0 && n > most / size))
      throw IoError(path_ + ", node " + node.path + ": declares more data than the file can hold; the file is damaged");
    n *= size;
  }
  return n;
}

void File::read(Node const& node, std::string const& type, void* data) const {
  check(cgio_read_all_data_type(handle_, node.id, type.c_str(), data), "read", node.path);
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
  check(cgio_write_all_data(handle_, node.id, data), "written", node.path);
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
  check(cgio_delete_node(handle_, parent.id, node.id), "removed", node.path);
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
