#include <gridmorph/core/error.hpp>
#include <gridmorph/io/file_check.hpp>
#include <gridmorph/io/read_file.hpp>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

namespace gridmorph::cgns {

namespace {

constexpr std::string_view hdf5_signature{"\x89HDF\r\n\x1a\n", 8};
constexpr std::string_view adf_signature{"ADF Database Version"};
/// What stands before the ADF signature: "@(#)", in files of some libraries as other four bytes.
constexpr std::size_t adf_signature_at = 4;

/// HDF5 allows a user block: the signature then stands at 512, 1024, 2048, ...
bool has_hdf5_signature(std::ifstream& file, std::uintmax_t size) {
  std::array<char, 8> found{};
  for (std::uintmax_t at = 0; at + found.size() <= size; at = at == 0 ? 512 : 2 * at) {
    file.clear();
    file.seekg(std::streamoff(at));
    if (!file.read(found.data(), found.size())) return false;
    if (std::string_view(found.data(), found.size()) == hdf5_signature) return true;
  }
  return false;
}

}  // namespace

namespace {

/// The format by the first bytes; nothing for other files.
std::optional<FileFormat> format_of(std::string const& path) {
  namespace fs = std::filesystem;
  std::error_code failure;
  auto const status = fs::status(path, failure);
  if (!fs::exists(status)) throw IoError(path + ": no such file; " + io::looked_for_at(path));
  if (fs::is_directory(status)) throw IoError(path + ": is a folder, not a file; name a mesh file in it");
  if (!fs::is_regular_file(status)) throw IoError(path + ": is not an ordinary file");
  auto const size = fs::file_size(path, failure);
  if (failure) throw IoError(path + ": cannot be examined: " + failure.message());

  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) throw IoError(path + ": cannot be opened for reading: " + std::strerror(errno));
  if (size == 0) throw IoError(path + ": is empty; expected a mesh");
  std::array<char, 32> head{};
  file.read(head.data(), std::streamsize(head.size()));
  if (std::string_view(head.data(), head.size()).substr(adf_signature_at).starts_with(adf_signature))
    return FileFormat::cgns_adf;
  if (has_hdf5_signature(file, size)) return FileFormat::cgns_hdf5;
  return std::nullopt;
}

}  // namespace

bool is_cgns(std::string const& path) { return format_of(path).has_value(); }

FileFormat check_file(std::string const& path) {
  auto const format = format_of(path);
  if (!format) throw IoError(path + ": is not a CGNS file (neither HDF5 nor ADF by its first bytes)");
  if (*format == FileFormat::cgns_adf) check_adf(path);
  return *format;
}

}  // namespace gridmorph::cgns
