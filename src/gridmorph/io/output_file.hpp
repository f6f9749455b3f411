// Output files that appear whole or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <string_view>

namespace gridmorph::io {

struct PendingName;

/// A temporary file beside the output, renamed onto it by commit() and removed otherwise.
///
/// The temporary file is in the same folder, so that the rename is one step of the file system. An output that is a
/// symbolic link is followed; one that is there already passes on its permissions and, where that is allowed, its
/// owner. Nothing is forced to the disk's surface: after a power failure either file may be there.
///
/// Temporary names are short (".gridmorph-<output>-<host>-<process>-<number>.part", the first two as hexadecimal
/// digits), so that outputs may have names of any length. Those that processes of this machine left behind for the same
/// output, killed before they could remove them, are removed.
class OutputFile {
 public:
  /// Creates the temporary file, empty. Throws IoError when there is no such folder or the output is there and no
  /// ordinary file, MachineError when it cannot be written. Of a file that has been read (FilesRead) IoError, too.
  explicit OutputFile(std::string const& output);
  ~OutputFile();
  OutputFile(OutputFile const&) = delete;
  OutputFile& operator=(OutputFile const&) = delete;

  [[nodiscard]] std::string const& path() const { return temporary_; }
  [[nodiscard]] std::string const& output() const { return output_; }

  /// Fills the temporary file with the bytes of another. Throws IoError (input) or MachineError (disk full, ...).
  void copy_from(std::string const& input) const;
  /// Makes the temporary file hold these bytes and nothing else. What takes the place of a longer text needs no more
  /// room on the disk. Throws MachineError.
  void write(std::string_view bytes) const;
  /// Makes sure that the temporary file can grow by that many bytes, and leaves it as long as it was. Throws
  /// MachineError.
  ///
  /// Called before a library writes: HDF5 cannot close a file that it failed to write, and the CGNS library then
  /// mistakes it for every file opened later. Only another program that fills the disk in between can still bring that
  /// about.
  void reserve(std::uint64_t bytes) const;
  void commit();
  /// Makes the temporary file another name of what is there now, which put_back() gives the place again; false where
  /// nothing is there.
  [[nodiscard]] bool hold_present() const;
  void put_back();
  /// Removes what is in the place of the output.
  void take_away() const;

 private:
  std::string output_;
  std::string temporary_;
  PendingName* pending_ = nullptr;
};

/// Several files that appear together or not at all.
class OutputFiles {
 public:
  /// The next one, to be filled; throws as OutputFile does.
  OutputFile& add(std::string const& output) { return files_.emplace_back(output); }
  [[nodiscard]] std::size_t size() const { return files_.size(); }
  /// Puts all files in their places, in the order in which they came: what names others comes last. Where one cannot be
  /// put in place, what was in the place of those before it comes back. Throws MachineError.
  void commit();

 private:
  std::deque<OutputFile> files_;
};

/// Removes the temporary files of all outputs that are not committed, where a program ends without leaving its scopes.
/// Does only what signal handlers may.
void remove_pending_files();

/// Makes SIGINT, SIGTERM and SIGHUP remove the temporary files of all outputs that are not committed from now on, and
/// then end the process as they would have without. For programs, not for libraries; a signal that is ignored stays
/// ignored.
void remove_pending_on_signals();

}  // namespace gridmorph::io
