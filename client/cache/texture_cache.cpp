#include "client/cache/texture_cache.hpp"

#include <utility>

namespace runstone {
namespace {

constexpr std::int64_t kTextureLayout = 1;
constexpr const char* kTextureSchema =
    "CREATE TABLE IF NOT EXISTS texture (id INTEGER PRIMARY KEY, hash BLOB NOT NULL UNIQUE, "
    "used INTEGER NOT NULL, bytes INTEGER NOT NULL, png BLOB NOT NULL);"
    "CREATE INDEX IF NOT EXISTS texture_used ON texture (used, bytes);";

}  // namespace

struct TextureCache::Tables {
  explicit Tables(CacheDatabase& d)
      : find(d.prepare("SELECT id, used, png FROM texture WHERE hash = ?1")),
        use(d.prepare("UPDATE texture SET used = ?2 WHERE id = ?1")),
        keep(d.prepare(
            "INSERT OR IGNORE INTO texture (hash, used, bytes, png) VALUES (?1,?2,?3,?4)")),
        replace(d.prepare("UPDATE texture SET png = ?2 WHERE hash = ?1")),
        oldest(d.prepare("SELECT id, bytes FROM texture ORDER BY used LIMIT ?1")),
        drop(d.prepare("DELETE FROM texture WHERE id = ?1")) {}
  sql::Statement find, use, keep, replace, oldest, drop;
};

TextureCache::TextureCache(const std::string& folder, std::uint64_t bytes_max)
    : file_(folder + "/textures.sqlite"), bytes_max_(bytes_max) {
  open();
  handle_failure();
}
TextureCache::~TextureCache() = default;

void TextureCache::open() {
  database_ = std::make_unique<CacheDatabase>(file_, kTextureSchema, kTextureLayout);
  tables_ = std::make_unique<Tables>(*database_);
  stamp_ = database_->integer("SELECT MAX(used) FROM texture") + 1;
  bytes_ = static_cast<std::uint64_t>(database_->integer("SELECT TOTAL(bytes) FROM texture"));
  database_->run("BEGIN");
  evict();
  database_->run("COMMIT");
  database_->run("PRAGMA incremental_vacuum");
}

void TextureCache::handle_failure() {
  if (database_->ok()) return;
  warning_ = "texture cache " + file_ + ": " + database_->error();
  if (database_->is_corrupt()) {
    tables_.reset();
    database_.reset();
    CacheDatabase::remove(file_);
    open();
    warning_ += "; a new one is begun";
  }
  if (!database_->ok()) {
    has_ended_ = true;
    warning_ += "; it is not used any more";
  }
}

std::string TextureCache::take_warning() { return std::exchange(warning_, {}); }

std::vector<TexturePart> TextureCache::find(std::span<const TextureHash> hashes) {
  std::vector<TexturePart> out;
  if (has_ended_) return out;
  Tables& t = *tables_;
  database_->run("BEGIN IMMEDIATE");
  for (const TextureHash& hash : hashes) {
    t.find.bind(1, hash);
    if (database_->step(t.find)) {
      const ByteView png = t.find.blob(2);
      const std::int64_t id = t.find.integer(0);
      const bool is_old = t.find.integer(1) != stamp_;
      if (png.size() <= kTextureBytesMax) out.push_back({hash, {png.begin(), png.end()}});
      t.find.reset();
      if (is_old) database_->run(t.use.bind(1, id).bind(2, stamp_));
    }
    t.find.reset();
  }
  database_->run("COMMIT");
  handle_failure();
  return out;
}

void TextureCache::keep(std::span<const TexturePart> parts) {
  if (has_ended_) return;
  Tables& t = *tables_;
  database_->run("BEGIN IMMEDIATE");
  for (const TexturePart& part : parts) {
    if (!database_->ok()) break;
    const std::uint64_t bytes = part.png.size() + CacheDatabase::kRowOverheadBytes;
    database_->run(t.keep.bind(1, part.hash)
                       .bind(2, stamp_)
                       .bind(3, static_cast<std::int64_t>(bytes))
                       .bind(4, ByteView(part.png)));
    if (!database_->ok()) break;
    if (database_->changes() != 0) {
      bytes_ += bytes;
    } else {
      // A picture that is stored again replaces its row: the client requests a picture only if its
      // row is missing or damaged.
      database_->run(t.replace.bind(1, part.hash).bind(2, ByteView(part.png)));
    }
  }
  ++stamp_;  // pictures of later batches count as newer
  evict();
  database_->run("COMMIT");
  handle_failure();
}

void TextureCache::evict() { database_->evict(tables_->oldest, tables_->drop, bytes_, bytes_max_); }

}  // namespace runstone
