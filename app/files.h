// SPDX-License-Identifier: GPL-3.0-or-later
// The disk. Scripts read below their own folder and write below the output folder; no symbolic link
// is followed, only regular files are opened, and files appear whole or not at all.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "interp/host.h"

namespace tranos::app {

using interp::HostError;

// A file that the user named on the command line.
tl::expected<std::string, HostError> ReadNamedFile(const std::string& path);

// Puts these bytes in the place of a file named on the command line: wholly, or not at all.
tl::expected<void, HostError> ReplaceNamedFile(const std::string& path, std::string_view bytes);

// What a script may read.
class Sandbox {
 public:
  // The folders, the script's own first.
  explicit Sandbox(std::vector<std::string> folders);
  ~Sandbox();
  Sandbox(const Sandbox&) = delete;
  Sandbox& operator=(const Sandbox&) = delete;

  tl::expected<std::string, HostError> Read(std::string_view path);
  // Marks a file named on the command line as one that must not be written.
  void NoteRead(const std::string& path);
  bool WasRead(std::uint64_t device, std::uint64_t inode) const;

 private:
  tl::expected<std::string, HostError> ReadBelow(int folder, const std::string& path);
  std::vector<std::pair<std::string, int>> folders_;  // path and descriptor
  std::vector<std::pair<std::uint64_t, std::uint64_t>> read_;
};

// Files that appear together: all are written aside first, and put in place only when all are
// complete.
class Writer {
 public:
  // Makes the folder if it is missing.
  static tl::expected<Writer, HostError> Into(const std::string& folder, const Sandbox* sandbox);
  Writer(Writer&& other) noexcept;
  Writer& operator=(Writer&&) = delete;
  ~Writer();  // what was not put in place is removed, folders made for it too

  // Whether a file may be put at this path below the folder. Refused: scripts, files that the run
  // has read, and the place of anything but a regular file.
  tl::expected<void, HostError> Check(const std::string& path) const;
  tl::expected<void, HostError> Write(const std::string& path, std::string_view bytes);
  tl::expected<void, HostError> PutInPlace();

 private:
  explicit Writer(const Sandbox* sandbox) : sandbox_(sandbox) {}
  tl::expected<void, HostError> CheckPlace(int folder, const std::string& name) const;
  int MakeFolder(const std::string& path);

  struct Pending {
    int folder;  // descriptor of the file's own folder
    std::string temporary, name;
  };
  int folder_ = -1;
  const Sandbox* sandbox_ = nullptr;
  std::vector<Pending> pending_;
  std::vector<std::string> made_;        // folders, from where the program was started
  std::vector<std::string> made_below_;  // folders below the output folder
};

}  // namespace tranos::app
