#include "files/disk/compression.hpp"

#include <zlib.h>
#include <zstd.h>
#include <algorithm>
#include <array>
#include <new>
#include <string>
#include <utility>

#include "files/disk/file.hpp"
#include "pirsim/error.hpp"

namespace pirsim::io {
namespace {

constexpr int gzip_format = 15 + 16;  // zlib.h: largest window, with a gzip header
constexpr std::size_t block = 1U << 17U;

void require_zstd(std::size_t result) {
  if (ZSTD_isError(result) != 0) {
    throw Error(ErrorCode::internal, std::string("the compression library failed: ") + ZSTD_getErrorName(result));
  }
}

}  // namespace

const std::vector<std::string>& table_endings() {
  static const std::vector<std::string> endings{".csv", ".csv.gz", ".csv.zst"};
  return endings;
}

Compression compression_of(const std::filesystem::path& file) {
  if (file.extension() == ".gz") return Compression::gzip;
  return file.extension() == ".zst" ? Compression::zstd : Compression::none;
}

std::filesystem::path without_compression(const std::filesystem::path& file) {
  return compression_of(file) == Compression::none ? file : std::filesystem::path(file).replace_extension();
}

// ---------------------------------------------------------------------------------------------------------- writing
struct DataWriter::Encoder {
  enum class Step { go_on, finish };
  std::ostream& out;
  explicit Encoder(std::ostream& stream) : out(stream) {}
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  virtual ~Encoder() = default;
  virtual void put(std::string_view bytes, Step step) = 0;
};

namespace {

void pass_on(std::ostream& out, const char* bytes, std::size_t size) {
  out.write(bytes, static_cast<std::streamsize>(size));
}

}  // namespace

struct PlainEncoder final : DataWriter::Encoder {
  using Encoder::Encoder;
  void put(std::string_view bytes, Step /*step*/) override { pass_on(out, bytes.data(), bytes.size()); }
};

struct GzipEncoder final : DataWriter::Encoder {
  z_stream state{};
  std::array<char, block> buffer{};
  explicit GzipEncoder(std::ostream& stream) : Encoder(stream) {
    if (deflateInit2(&state, Z_DEFAULT_COMPRESSION, Z_DEFLATED, gzip_format, 8, Z_DEFAULT_STRATEGY) != Z_OK) {
      throw std::bad_alloc();
    }
  }
  ~GzipEncoder() override { deflateEnd(&state); }
  void put(std::string_view bytes, Step step) override {
    constexpr std::size_t most = 1U << 30U;  // zlib counts in 32 bits
    do {
      const std::string_view part = bytes.substr(0, most);
      bytes.remove_prefix(part.size());
      state.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(part.data()));
      state.avail_in = static_cast<uInt>(part.size());
      do {
        state.next_out = reinterpret_cast<Bytef*>(buffer.data());
        state.avail_out = static_cast<uInt>(buffer.size());
        deflate(&state, step == Step::finish && bytes.empty() ? Z_FINISH : Z_NO_FLUSH);
        pass_on(out, buffer.data(), buffer.size() - state.avail_out);
      } while (state.avail_out == 0);
    } while (!bytes.empty());
  }
};

struct ZstdEncoder final : DataWriter::Encoder {
  std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> state{ZSTD_createCCtx(), &ZSTD_freeCCtx};
  std::array<char, block> buffer{};
  explicit ZstdEncoder(std::ostream& stream) : Encoder(stream) {
    if (!state) throw std::bad_alloc();
    require_zstd(ZSTD_CCtx_setParameter(state.get(), ZSTD_c_checksumFlag, 1));
  }
  void put(std::string_view bytes, Step step) override {
    ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
    const auto mode = step == Step::finish ? ZSTD_e_end : ZSTD_e_continue;
    while (true) {
      ZSTD_outBuffer made{buffer.data(), buffer.size(), 0};
      const std::size_t left = ZSTD_compressStream2(state.get(), &made, &in, mode);
      require_zstd(left);
      pass_on(out, buffer.data(), made.pos);
      if (step == Step::finish ? left == 0 : in.pos == in.size) return;
    }
  }
};

DataWriter::DataWriter(std::ostream& out, Compression compression) {
  if (compression == Compression::gzip) {
    encoder_ = std::make_unique<GzipEncoder>(out);
  } else if (compression == Compression::zstd) {
    encoder_ = std::make_unique<ZstdEncoder>(out);
  } else {
    encoder_ = std::make_unique<PlainEncoder>(out);
  }
}
DataWriter::~DataWriter() = default;
void DataWriter::write(std::string_view bytes) { encoder_->put(bytes, Encoder::Step::go_on); }
void DataWriter::finish() { encoder_->put({}, Encoder::Step::finish); }

// ---------------------------------------------------------------------------------------------------------- reading
struct DataReader::Decoder {
  std::filesystem::path path;
  DataReader::ByteSource source;
  Decoder(std::filesystem::path name, DataReader::ByteSource bytes) : path(std::move(name)), source(std::move(bytes)) {}
  Decoder(const Decoder&) = delete;
  Decoder& operator=(const Decoder&) = delete;
  virtual ~Decoder() = default;
  virtual std::size_t get(char* to, std::size_t size) { return source(to, size); }

 protected:
  std::array<char, block> buffer{};
  [[noreturn]] void refuse(const std::string& why) const { throw Error(ErrorCode::input, Where{path.string()}, why); }
};

struct GzipDecoder final : DataReader::Decoder {
  z_stream state{};
  bool in_member = false;
  GzipDecoder(std::filesystem::path name, DataReader::ByteSource bytes) : Decoder(std::move(name), std::move(bytes)) {
    if (inflateInit2(&state, gzip_format) != Z_OK) throw std::bad_alloc();
  }
  ~GzipDecoder() override { inflateEnd(&state); }
  std::size_t get(char* to, std::size_t size) override {
    size = std::min<std::size_t>(size, 1U << 30U);
    state.next_out = reinterpret_cast<Bytef*>(to);
    state.avail_out = static_cast<uInt>(size);
    while (state.avail_out > 0) {
      if (state.avail_in == 0) {
        state.next_in = reinterpret_cast<Bytef*>(buffer.data());
        state.avail_in = static_cast<uInt>(source(buffer.data(), buffer.size()));
        if (state.avail_in == 0) break;
      }
      in_member = true;
      const int result = inflate(&state, Z_NO_FLUSH);
      if (result == Z_MEM_ERROR) throw std::bad_alloc();
      if (result != Z_OK && result != Z_STREAM_END && result != Z_BUF_ERROR) refuse("is damaged: not valid gzip");
      if (result == Z_STREAM_END) {
        in_member = false;
        inflateReset(&state);
      }
    }
    if (state.avail_out == size && in_member) refuse("is cut short");
    return size - state.avail_out;
  }
};

struct ZstdDecoder final : DataReader::Decoder {
  std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> state{ZSTD_createDCtx(), &ZSTD_freeDCtx};
  ZSTD_inBuffer in{buffer.data(), 0, 0};
  std::size_t wanted = 0;  ///< 0: between frames
  ZstdDecoder(std::filesystem::path name, DataReader::ByteSource bytes) : Decoder(std::move(name), std::move(bytes)) {
    if (!state) throw std::bad_alloc();
  }
  std::size_t get(char* to, std::size_t size) override {
    ZSTD_outBuffer made{to, size, 0};
    while (made.pos < made.size) {
      const std::size_t before = made.pos;
      if (in.pos == in.size) {
        in = {buffer.data(), source(buffer.data(), buffer.size()), 0};
        if (in.size == 0 && wanted == 0) break;
      }
      const bool at_end = in.size == 0;
      wanted = ZSTD_decompressStream(state.get(), &made, &in);
      if (ZSTD_isError(wanted) != 0) refuse(std::string("is damaged: ") + ZSTD_getErrorName(wanted));
      if (at_end && made.pos == before) {
        if (made.pos == 0) refuse("is cut short");
        break;
      }
    }
    return made.pos;
  }
};

DataReader::DataReader(const std::filesystem::path& path, Compression compression, ByteSource source) {
  switch (compression) {
    case Compression::gzip:
      decoder_ = std::make_unique<GzipDecoder>(path, std::move(source));
      break;
    case Compression::zstd:
      decoder_ = std::make_unique<ZstdDecoder>(path, std::move(source));
      break;
    case Compression::none:
      decoder_ = std::make_unique<Decoder>(path, std::move(source));
  }
}
DataReader::DataReader(const std::filesystem::path& file)
    : DataReader(file, compression_of(file),
                 [opened = std::make_shared<PosixFile>(file, PosixFile::Mode::read)](char* to, std::size_t size) {
                   return opened->read(to, size);
                 }) {}
DataReader::~DataReader() = default;
std::size_t DataReader::read(char* to, std::size_t size) { return decoder_->get(to, size); }

std::string decompressed(Input input, std::size_t max_bytes) {
  const std::string_view bytes = input.bytes;
  const Compression compression = bytes.starts_with("\x1F\x8B")           ? Compression::gzip
                                  : bytes.starts_with("\x28\xB5\x2F\xFD") ? Compression::zstd
                                                                          : Compression::none;
  if (compression == Compression::none) return std::move(input.bytes);
  DataReader reader(input.path, compression, [left = bytes](char* to, std::size_t size) mutable {
    const std::size_t n = left.copy(to, size);
    left.remove_prefix(n);
    return n;
  });
  std::string text;
  std::string part(block, '\0');
  while (const std::size_t n = reader.read(part.data(), part.size())) {
    text.append(part, 0, n);
    if (text.size() > max_bytes) {
      throw Error(ErrorCode::input, Where{input.path.string()},
                  "holds more than " + std::to_string(max_bytes / 1'000'000) + " MB, decompressed");
    }
  }
  return text;
}

}  // namespace pirsim::io
