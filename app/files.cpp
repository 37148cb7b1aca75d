// SPDX-License-Identifier: GPL-3.0-or-later
#include "app/files.h"

#include <dirent.h>
#include <fcntl.h>
#include <linux/openat2.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace tranos::app {

namespace {

constexpr std::uint64_t kLargest = std::uint64_t{1} << 31;  // bytes of a file that is read

tl::unexpected<HostError> Refuse(HostError::Kind kind, std::string detail) {
  return tl::unexpected(HostError{kind, std::move(detail)});
}
tl::unexpected<HostError> FromErrno() {
  const int number = errno;
  const auto kind = number == ENOENT ? HostError::kMissing : HostError::kFailed;
  return Refuse(kind, std::strerror(number));
}

// Opens below a folder, never through a link or out of it.
int OpenBelow(int folder, const std::string& path, int flags, int mode = 0) {
  open_how how{};
  how.flags = static_cast<std::uint64_t>(flags | O_CLOEXEC);
  how.mode = static_cast<std::uint64_t>(mode);
  how.resolve = RESOLVE_BENEATH | RESOLVE_NO_SYMLINKS | RESOLVE_NO_MAGICLINKS;
  return static_cast<int>(syscall(SYS_openat2, folder, path.c_str(), &how, sizeof how));
}

tl::expected<std::string, HostError> ReadAll(int file) {
  std::string bytes;
  struct stat info {};
  if (fstat(file, &info) != 0) return FromErrno();
  if (!S_ISREG(info.st_mode)) return Refuse(HostError::kOutside, "not a regular file");
  if (static_cast<std::uint64_t>(info.st_size) > kLargest)
    return Refuse(HostError::kFailed, "the file is too large");
  bytes.resize(static_cast<std::size_t>(info.st_size));
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = read(file, bytes.data() + done, bytes.size() - done);
    if (got < 0) return FromErrno();
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  bytes.resize(done);
  return bytes;
}

bool EndsWith(std::string_view text, std::string_view end) {
  if (text.size() < end.size()) return false;
  const std::string_view tail = text.substr(text.size() - end.size());
  return std::equal(tail.begin(), tail.end(), end.begin(),
                    [](char a, char b) { return (a | 0x20) == (b | 0x20); });
}

}  // namespace

tl::expected<std::string, HostError> ReadNamedFile(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0) return FromErrno();
  auto bytes = ReadAll(file);
  close(file);
  return bytes;
}

namespace {

tl::expected<void, HostError> WriteAll(int file, std::string_view bytes) {
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t put = write(file, bytes.data() + done, bytes.size() - done);
    if (put < 0) return FromErrno();
    done += static_cast<std::size_t>(put);
  }
  return {};
}

}  // namespace

tl::expected<void, HostError> ReplaceNamedFile(const std::string& given, std::string_view bytes) {
  // What a link leads to is replaced, and not the link.
  std::string path = given;
  if (char* const real = realpath(given.c_str(), nullptr)) {
    path = real;
    std::free(real);
  }
  struct stat info {};
  const bool there = stat(path.c_str(), &info) == 0;
  if (there && !S_ISREG(info.st_mode)) return Refuse(HostError::kOutside, "not a regular file");
  const std::string temporary = path + ".tranos-" + std::to_string(getpid());
  const int file = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) return FromErrno();
  if (there) fchmod(file, info.st_mode & 07777);
  auto written = WriteAll(file, bytes);
  if (close(file) != 0 && written) written = FromErrno();
  if (written && rename(temporary.c_str(), path.c_str()) != 0) written = FromErrno();
  if (!written) unlink(temporary.c_str());
  return written;
}

Sandbox::Sandbox(std::vector<std::string> folders) {
  for (std::string& folder : folders) {
    const int descriptor = open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC);
    if (descriptor >= 0) folders_.emplace_back(std::move(folder), descriptor);
  }
}

Sandbox::~Sandbox() {
  for (const auto& [path, descriptor] : folders_) close(descriptor);
}

tl::expected<std::string, HostError> Sandbox::Read(std::string_view path) {
  const std::string wanted(path);
  if (wanted.find('\0') != std::string::npos)
    return Refuse(HostError::kOutside, "the path holds a NUL");
  tl::expected<std::string, HostError> result =
      Refuse(HostError::kOutside, "there is no folder to read from");
  for (const auto& [folder, descriptor] : folders_) {
    std::string below = wanted;
    if (wanted.starts_with('/')) {
      // An absolute path may lead below a folder that was allowed by that path.
      if (!wanted.starts_with(folder + "/")) {
        result = Refuse(HostError::kOutside,
                        "it is not below the script's folder, nor one given by --allow");
        continue;
      }
      below = wanted.substr(folder.size() + 1);
    }
    result = ReadBelow(descriptor, below);
    if (result || result.error().kind != HostError::kMissing) return result;
  }
  return result;
}

tl::expected<std::string, HostError> Sandbox::ReadBelow(int folder, const std::string& path) {
  const int file = OpenBelow(folder, path, O_RDONLY | O_NONBLOCK);
  if (file < 0) {
    if (errno == EXDEV) return Refuse(HostError::kOutside, "it leads out of the script's folder");
    if (errno == ELOOP) return Refuse(HostError::kOutside, "it leads through a symbolic link");
    if (errno == ENXIO) return Refuse(HostError::kOutside, "not a regular file");
    return FromErrno();
  }
  struct stat info {};
  if (fstat(file, &info) == 0) read_.emplace_back(info.st_dev, info.st_ino);
  auto bytes = ReadAll(file);
  close(file);
  return bytes;
}

void Sandbox::NoteRead(const std::string& path) {
  struct stat info {};
  if (stat(path.c_str(), &info) == 0) read_.emplace_back(info.st_dev, info.st_ino);
}

bool Sandbox::WasRead(std::uint64_t device, std::uint64_t inode) const {
  return std::find(read_.begin(), read_.end(), std::pair(device, inode)) != read_.end();
}

tl::expected<Writer, HostError> Writer::Into(const std::string& folder, const Sandbox* sandbox) {
  Writer writer(sandbox);
  for (std::size_t at = 0; at != std::string::npos;) {
    at = folder.find('/', at + 1);
    const std::string part = folder.substr(0, at);
    if (mkdir(part.c_str(), 0777) == 0)
      writer.made_.push_back(part);
    else if (errno != EEXIST)
      return FromErrno();
  }
  writer.folder_ = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (writer.folder_ < 0) return FromErrno();
  return writer;
}

Writer::Writer(Writer&& other) noexcept
    : folder_(std::exchange(other.folder_, -1)),
      sandbox_(other.sandbox_),
      pending_(std::exchange(other.pending_, {})),
      made_(std::exchange(other.made_, {})),
      made_below_(std::exchange(other.made_below_, {})) {}

Writer::~Writer() {
  for (const Pending& file : pending_) {
    if (!file.temporary.empty()) unlinkat(file.folder, file.temporary.c_str(), 0);
    close(file.folder);
  }
  for (auto path = made_below_.rbegin(); path != made_below_.rend(); ++path) {
    unlinkat(folder_, path->c_str(), AT_REMOVEDIR);
  }
  if (folder_ >= 0) close(folder_);
  for (auto path = made_.rbegin(); path != made_.rend(); ++path) rmdir(path->c_str());
}

namespace {

// "plans/east.png" → "plans" and "east.png"; "." if the path names no folder.
std::pair<std::string, std::string> Split(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return {".", path};
  return {path.substr(0, slash), path.substr(slash + 1)};
}

tl::expected<void, HostError> CheckPath(const std::string& path) {
  if (path.starts_with('/'))
    return Refuse(HostError::kOutside, "it is not below the output folder");
  if (std::any_of(path.begin(), path.end(),
                  [](unsigned char c) { return c < 0x20 || c == 0x7f; })) {
    return Refuse(HostError::kOutside, "the name holds a control character");
  }
  const std::string name = Split(path).second;
  if (name.empty() || name == "." || name == "..")
    return Refuse(HostError::kOutside, "it names no file");
  if (EndsWith(path, ".trn")) return Refuse(HostError::kProtected, "a run writes no script");
  return {};
}

tl::unexpected<HostError> FolderError() {
  if (errno == EXDEV || errno == ELOOP)
    return Refuse(HostError::kOutside, "it leads out of the output folder");
  return FromErrno();
}

}  // namespace

tl::expected<void, HostError> Writer::CheckPlace(int folder, const std::string& name) const {
  struct stat info {};
  if (fstatat(folder, name.c_str(), &info, AT_SYMLINK_NOFOLLOW) != 0) return {};
  if (S_ISLNK(info.st_mode)) return Refuse(HostError::kOutside, "a symbolic link has this name");
  if (!S_ISREG(info.st_mode))
    return Refuse(HostError::kOutside, "something that is no regular file has this name");
  if (sandbox_ && sandbox_->WasRead(info.st_dev, info.st_ino)) {
    return Refuse(HostError::kProtected, "the run has read this file");
  }
  return {};
}

tl::expected<void, HostError> Writer::Check(const std::string& path) const {
  if (auto sound = CheckPath(path); !sound) return sound;
  const auto [above, name] = Split(path);
  const int folder = OpenBelow(folder_, above, O_RDONLY | O_DIRECTORY);
  if (folder < 0 && errno == ENOENT) return {};
  if (folder < 0) return FolderError();
  auto free = CheckPlace(folder, name);
  close(folder);
  return free;
}

// The folder of a file, made if it is missing.
int Writer::MakeFolder(const std::string& path) {
  for (std::size_t slash = 0; slash != std::string::npos;) {
    slash = path.find('/', slash + 1);
    const auto [above, name] = Split(path.substr(0, slash));
    const int parent = OpenBelow(folder_, above, O_RDONLY | O_DIRECTORY);
    if (parent < 0) return -1;
    if (mkdirat(parent, name.c_str(), 0777) == 0) made_below_.push_back(path.substr(0, slash));
    close(parent);
  }
  return OpenBelow(folder_, path, O_RDONLY | O_DIRECTORY);
}

tl::expected<void, HostError> Writer::Write(const std::string& path, std::string_view bytes) {
  if (auto sound = CheckPath(path); !sound) return sound;
  const auto [above, name] = Split(path);
  const int folder =
      above == "." ? OpenBelow(folder_, above, O_RDONLY | O_DIRECTORY) : MakeFolder(above);
  if (folder < 0) return FolderError();
  pending_.push_back({folder, "", name});
  if (auto free = CheckPlace(folder, name); !free) return free;
  const std::string temporary =
      ".tranos-" + std::to_string(getpid()) + "-" + std::to_string(pending_.size());
  const int file =
      openat(folder, temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (file < 0) return FromErrno();
  pending_.back().temporary = temporary;
  auto written = WriteAll(file, bytes);
  if (close(file) != 0 && written) written = FromErrno();
  return written;
}

tl::expected<void, HostError> Writer::PutInPlace() {
  for (Pending& file : pending_) {
    if (renameat(file.folder, file.temporary.c_str(), file.folder, file.name.c_str()) != 0)
      return FromErrno();
    file.temporary.clear();
    made_.clear();
    made_below_.clear();
  }
  return {};
}

}  // namespace tranos::app
