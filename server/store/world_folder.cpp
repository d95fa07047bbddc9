#include "server/store/world_folder.hpp"

#include <sodium.h>

#include <filesystem>
#include <utility>

#include "common/generate/spawn_point.hpp"
#include "common/materials/look_on_shape.hpp"
#include "common/os/text_file.hpp"
#include "server/store/postgres_backend.hpp"

namespace runstone {
namespace {

constexpr int kSeedDraws = 64;

Result<WorldMeta, std::string> new_meta(const WorldCreation& creation) {
  if (creation.edge != 16 && creation.edge != 32 && creation.edge != 64 && creation.edge != 128) {
    return failure("--edge " + std::to_string(creation.edge) +
                   ": chunks have an edge of 16, 32, 64 or 128");
  }
  auto materials = read_materials(creation.materials_file, creation.generator);
  if (!materials) return failure(materials.error());
  WorldMeta meta;
  meta.chunk_edge = creation.edge;
  meta.generator.name = creation.generator;
  meta.generator.seed = creation.seed.value_or(0);
  meta.generator.parameters = creation.generator_parameters;
  meta.materials = *std::move(materials);
  auto generator = make_generator(meta.generator, meta.materials);
  // A seed that is drawn gives dry ground at the origin, where players then arrive, if the generator
  // has such ground at all.
  for (int i = 0; generator && !creation.seed && i < kSeedDraws; ++i) {
    if (i > 0 && (is_origin_dry(**generator, meta.materials) || (*generator)->spawn())) break;
    // 32 bits, so that people can read it out and type it.
    meta.generator.seed = randombytes_random();
    generator = make_generator(meta.generator, meta.materials);
  }
  if (!generator)
    return failure("--generator " + meta.generator.name + ": " + generator.error().what);
  const VoxelPos spawn = spawn_point(**generator, meta.materials);
  meta.spawn = {spawn.x + 0.5, static_cast<double>(spawn.y), spawn.z + 0.5};
  draw_identity(meta);
  return meta;
}

}  // namespace

bool has_world(const std::string& place) {
  if (is_database(place)) {
    const auto there = has_postgres_world(place);
    return !there || *there;
  }
  std::error_code ignored;
  return std::filesystem::exists(std::filesystem::path(place) / "world.sqlite", ignored);
}

Result<MaterialTable, std::string> read_materials(const std::string& file,
                                                  const std::string& generator) {
  if (file.empty())
    return generator == "landscape" ? landscape_material_table() : default_material_table();
  const auto toml = read_text_file(file, kTextFileBytesMax);
  if (!toml) return failure(toml.error());
  auto table = parse_material_table(*toml, file);
  if (!table) return failure(table.error().message());
  return with_looks_on_shapes(*table);
}

void draw_identity(WorldMeta& meta) {
  randombytes_buf(meta.world_id.data(), meta.world_id.size());
  randombytes_buf(meta.server_key_seed.data(), meta.server_key_seed.size());
}

Result<std::unique_ptr<Generator>, std::string> generator_of(const WorldInfo& world) {
  const WorldMeta& meta = world.meta();
  auto generator = make_generator(meta.generator, meta.materials);
  if (!generator) {
    return failure(world.file() + ": meta generator=" + meta.generator.name + " version=" +
                   std::to_string(meta.generator.version) + ": " + generator.error().what);
  }
  return *std::move(generator);
}

Result<OpenedWorld, std::string> open_or_create_world(const std::string& place,
                                                      const WorldCreation& creation,
                                                      bool accept_losses, const LeaseTerms& lease) {
  OpenedWorld opened;
  opened.is_new = !has_world(place);
  // There is no such file if the place is a database.
  const auto file = std::filesystem::path(place) / "world.sqlite";
  std::error_code ignored;
  if (!opened.is_new && std::filesystem::file_size(file, ignored) == 0) {
    return failure(
        file.string() +
        ": is empty, as a creation that was cut short leaves it: delete it to begin anew");
  }
  if (opened.is_new) {
    const auto meta = new_meta(creation);
    if (!meta) return failure(meta.error());
    auto store = create_world(place, *meta, "", lease);
    if (!store) return failure(store.error().message());
    opened.store = *std::move(store);
  } else {
    auto store =
        open_world(place, accept_losses ? StoreAccess::repair : StoreAccess::read_write, "", lease);
    if (!store) return failure(store.error().message());
    opened.store = *std::move(store);
    if (accept_losses) {
      auto losses = opened.store->accept_losses();
      if (!losses) return failure(losses.error().message());
      opened.losses = *std::move(losses);
    }
  }
  using std::filesystem::perms;
  const perms others = perms::group_read | perms::others_read;
  const auto status = std::filesystem::status(file, ignored);
  opened.is_readable_by_others =
      std::filesystem::exists(status) && (status.permissions() & others) != perms::none;
  auto generator = generator_of(*opened.store);
  if (!generator) return failure(generator.error());
  opened.generator = *std::move(generator);
  return opened;
}

}  // namespace runstone
