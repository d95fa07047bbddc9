// built_in_materials: the material table of a world whose own table is lost. A world is created
// with the built-in table of its generator, with that of a file, or with that of an imported world.
// The built-in table is taken only if nothing in base and log contradicts it.
#pragma once
#include <string>

#include "common/generate/generator.hpp"
#include "common/sql/database.hpp"
#include "server/store/store_error.hpp"

namespace runstone {

/// A table that fits a world, or the reason why none does.
struct BuiltInMaterials {
  MaterialTable table;
  std::string name;   // for the host; empty: no table fits
  std::string fault;  // of the table that was tried last; empty if one fits
};

/// The columns of `meta` that say what the table was like.
struct MaterialsPin {
  GeneratorPin generator;
  std::uint16_t chunk_edge = 32;
  bool has_shapes = false;  // a material has or had a shape, as far as `meta` still says
};

/// Returns the built-in table with which the world was created, if there is one such that
///   - the generator can be made with it;
///   - the world was not imported;
///   - the records of the log that add materials or give shapes continue it;
///   - each voxel of the base, each edit and each texture has a material of the table as it was
///     then.
/// `database` has the rows of `base`, `rights_record` and `edit_log`, each of which its checksum
/// proves. Fails as the database. Cost: one pass over these tables.
StoreResult<BuiltInMaterials> find_built_in_materials(sql::Database& database,
                                                      const MaterialsPin& pin);

}  // namespace runstone
