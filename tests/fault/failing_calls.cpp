// To be loaded before everything else (LD_PRELOAD): makes calls of the C library fail, so that tests can see what
// pirsim does then. PIRSIM_FAIL_CALL names the call: write, open (of files to be written), rename, truncate or malloc;
// PIRSIM_FAIL_AT which one of them, from 1; PIRSIM_FAIL_ERRNO the reason. From then on every such call fails, as on a
// full disk, and the first failing write still writes half of its bytes. Allocations are counted from the moment that
// the first .yaml file is opened, and with PIRSIM_FAIL_ONCE only one fails.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" void* __libc_malloc(std::size_t);

namespace {

enum class Kind { none, write, open, rename, truncate, malloc };

Kind kind_wanted() {
  const char* name = std::getenv("PIRSIM_FAIL_CALL");
  if (name == nullptr) return Kind::none;
  if (std::strcmp(name, "write") == 0) return Kind::write;
  if (std::strcmp(name, "open") == 0) return Kind::open;
  if (std::strcmp(name, "rename") == 0) return Kind::rename;
  if (std::strcmp(name, "truncate") == 0) return Kind::truncate;
  return std::strcmp(name, "malloc") == 0 ? Kind::malloc : Kind::none;
}

long number(const char* name, long otherwise) {
  const char* text = std::getenv(name);
  return text == nullptr ? otherwise : std::atol(text);
}

struct Plan {
  Kind kind = kind_wanted();
  long at = number("PIRSIM_FAIL_AT", 0);
  int reason = static_cast<int>(number("PIRSIM_FAIL_ERRNO", ENOSPC));
  bool once = std::getenv("PIRSIM_FAIL_ONCE") != nullptr;
};

std::atomic<long> calls{0};
std::atomic<bool> loading{false};

const Plan& plan() {
  static const Plan the_plan;
  return the_plan;
}

/// 0: goes well; 1: the first that fails; 2: a later one.
int failure(Kind kind) {
  if (plan().kind != kind) return 0;
  const long n = ++calls;
  if (n < plan().at || (plan().once && n > plan().at)) return 0;
  errno = plan().reason;
  return n == plan().at ? 1 : 2;
}

template <typename Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

void notice(const char* path) {
  const std::size_t length = std::strlen(path);
  if (length > 5 && std::strcmp(path + length - 5, ".yaml") == 0) loading = true;
}

int open_unless(const char* name, const char* path, int flags, va_list arguments) {
  notice(path);
  const bool writes = (flags & (O_WRONLY | O_RDWR)) != 0;
  if (writes && failure(Kind::open) != 0) return -1;
  const auto mode = (flags & O_CREAT) != 0 ? va_arg(arguments, mode_t) : mode_t{0};
  return next<int(const char*, int, ...)>(name)(path, flags, mode);
}

FILE* fopen_unless(const char* name, const char* path, const char* mode) {
  notice(path);
  if (std::strpbrk(mode, "wa+") != nullptr && failure(Kind::open) != 0) return nullptr;
  return next<FILE*(const char*, const char*)>(name)(path, mode);
}

}  // namespace

extern "C" {

ssize_t write(int file, const void* bytes, std::size_t size) {
  static auto* const real = next<ssize_t(int, const void*, std::size_t)>("write");
  const int fails = file > STDERR_FILENO ? failure(Kind::write) : 0;
  if (fails == 1 && size > 1) return real(file, bytes, size / 2);
  return fails != 0 ? -1 : real(file, bytes, size);
}
ssize_t writev(int file, const iovec* pieces, int count) {
  static auto* const real = next<ssize_t(int, const iovec*, int)>("writev");
  return file > STDERR_FILENO && failure(Kind::write) != 0 ? -1 : real(file, pieces, count);
}
int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int result = open_unless("open", path, flags, arguments);
  va_end(arguments);
  return result;
}
int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int result = open_unless("open64", path, flags, arguments);
  va_end(arguments);
  return result;
}
FILE* fopen(const char* path, const char* mode) { return fopen_unless("fopen", path, mode); }
FILE* fopen64(const char* path, const char* mode) { return fopen_unless("fopen64", path, mode); }
int rename(const char* from, const char* to) noexcept {
  return failure(Kind::rename) != 0 ? -1 : next<int(const char*, const char*)>("rename")(from, to);
}
int ftruncate(int file, off_t size) noexcept {
  return failure(Kind::truncate) != 0 ? -1 : next<int(int, off_t)>("ftruncate")(file, size);
}
int ftruncate64(int file, off64_t size) noexcept {
  return failure(Kind::truncate) != 0 ? -1 : next<int(int, off64_t)>("ftruncate64")(file, size);
}

#ifdef PIRSIM_FAILING_MALLOC
void* malloc(std::size_t size) {
  if (loading && failure(Kind::malloc) != 0) {
    errno = ENOMEM;
    return nullptr;
  }
  return __libc_malloc(size);
}
#endif
}
