/* runstone.h: the C interface of Runstone's libraries: chunks of runs, their bytes, edits, quads,
 * levels of detail, collision, and the client that joins a server. docs/c.md has programs, and the
 * rules below in full.
 *
 * Handles. A handle is a pointer to an opaque struct. Functions that end in _create, _clone,
 * _decode or _build give a new one, which the caller frees with the _free function of its kind.
 * Freeing NULL does nothing. A NULL handle, a handle of another kind and most handles that were
 * freed are refused.
 *
 * Status. Every call that can fail returns a runstone_status. RUNSTONE_OK is 0. After every other
 * status, runstone_last_error() returns a text that says why. Outputs are not changed, except
 * counts; output handles become NULL. No exception leaves a function, and no argument ends the
 * process, as long as pointers point to as many elements as the call says.
 *
 * Buffers. The caller owns all buffers. A call with `out, capacity, count` writes the number of
 * elements that there are to *count. With a capacity of 0 it does nothing else, and `out` may be
 * NULL. With a smaller capacity than needed it returns RUNSTONE_BUFFER_TOO_SMALL and writes no
 * element.
 *
 * Versioned structs begin with struct_size, to which the caller sets sizeof(the struct). A later
 * library fills only that many bytes, so that programs need not be compiled again.
 *
 * Threads. Any number of threads may use a handle by functions that take it as a pointer to
 * const. A function that takes a pointer to non-const needs the handle for itself. Each thread
 * has its own last error and its own buffers, which live until the thread ends.
 *
 * Texts are UTF-8 and end with a zero.
 *
 * Units. Positions are voxels or chunks, y is up. A material is 0 (empty) to 65535. The sides of
 * a chunk are 8 to 128 voxels; chunks of a world are cubes of edge 16, 32, 64 or 128. */
#ifndef RUNSTONE_H
#define RUNSTONE_H

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define RUNSTONE_API __attribute__((visibility("default")))
#else
#define RUNSTONE_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The number of this interface, which is that of librunstone.so.N. It rises when a function, a
 * struct or a value is removed or changes its meaning. Functions, structs, fields at the end and
 * values may be added. */
#define RUNSTONE_ABI 0

typedef int32_t runstone_status;
enum {
  RUNSTONE_OK = 0,
  RUNSTONE_TRUNCATED = 1,        /* the bytes end early */
  RUNSTONE_TRAILING_BYTES = 2,   /* bytes are left over */
  RUNSTONE_NOT_CANONICAL = 3,    /* another spelling than the accepted one */
  RUNSTONE_BAD_VALUE = 4,        /* a field of bytes, runs or an edit is outside its range */
  RUNSTONE_BAD_VERSION = 5,      /* bytes of an unknown version */
  RUNSTONE_LIMIT_EXCEEDED = 6,   /* larger than a documented limit */
  RUNSTONE_BAD_CHECKSUM = 7,     /* damaged bytes */
  RUNSTONE_BROKEN_INVARIANT = 8, /* a rule of runs does not hold */
  RUNSTONE_UNKNOWN_KIND = 9,     /* an unknown encoding or kind of edit */
  RUNSTONE_NOT_FOUND = 10,       /* a client has no such chunk, material or event */
  RUNSTONE_IO_FAILED = 11,       /* the network or a file of a client failed */
  RUNSTONE_NOT_PERMITTED = 12,   /* the player of a client may not do this */
  RUNSTONE_BAD_ARGUMENT =
      13, /* NULL, a number out of range, or handles that do not belong together */
  RUNSTONE_BAD_HANDLE = 14,       /* a handle of another kind, or one that was freed */
  RUNSTONE_BUFFER_TOO_SMALL = 15, /* *count says how many elements are needed */
  RUNSTONE_NO_MEMORY = 16,
  RUNSTONE_DAMAGED = 17,    /* memory ran out while the handle was changed: only free it */
  RUNSTONE_INTERNAL = 18,   /* a defect of the library */
  RUNSTONE_UNSUPPORTED = 19 /* this build of the library has no client */
};

/* Axis orders, fastest axis first. */
enum {
  RUNSTONE_ORDER_XYZ = 0,
  RUNSTONE_ORDER_XZY = 1,
  RUNSTONE_ORDER_YXZ = 2,
  RUNSTONE_ORDER_YZX = 3,
  RUNSTONE_ORDER_ZXY = 4,
  RUNSTONE_ORDER_ZYX = 5,
  RUNSTONE_ORDER_CHEAPEST =
      6 /* the one with the fewest runs: runstone_chunk_reorder() alone takes it */
};

/* Directions, of faces and of neighbours. NONE: a ray that begins inside a voxel. */
enum {
  RUNSTONE_NEG_X = 0,
  RUNSTONE_POS_X = 1,
  RUNSTONE_NEG_Y = 2,
  RUNSTONE_POS_Y = 3,
  RUNSTONE_NEG_Z = 4,
  RUNSTONE_POS_Z = 5,
  RUNSTONE_DIRECTION_NONE = 6
};

enum { RUNSTONE_ENCODING_RAW = 1, RUNSTONE_ENCODING_PACKED = 2, RUNSTONE_ENCODING_CODED = 3 };
enum {
  RUNSTONE_MASK_EVERYTHING = 0,
  RUNSTONE_MASK_ONLY_EMPTY = 1,
  RUNSTONE_MASK_ONLY_SOLID = 2,
  RUNSTONE_MASK_ONLY_MATERIAL = 3
};
enum { RUNSTONE_EMPTY = 0, RUNSTONE_OPAQUE = 1, RUNSTONE_TRANSPARENT = 2 }; /* visibilities */
enum { RUNSTONE_PASS_OPAQUE = 0, RUNSTONE_PASS_TRANSPARENT = 1 };
enum { RUNSTONE_SHAPE_BOXES = 0, RUNSTONE_SHAPE_CROSSED = 1 }; /* forms of shapes */

/* The fields of a quad of 8 bytes: its lowest bit and the number of bits. WIDTH and HEIGHT hold one
 * less. runstone_quads.glsl has the same numbers for shaders. */
enum {
  RUNSTONE_QUAD_X_SHIFT = 0,
  RUNSTONE_QUAD_X_BITS = 7,
  RUNSTONE_QUAD_Y_SHIFT = 7,
  RUNSTONE_QUAD_Y_BITS = 7,
  RUNSTONE_QUAD_Z_SHIFT = 14,
  RUNSTONE_QUAD_Z_BITS = 7,
  RUNSTONE_QUAD_WIDTH_SHIFT = 21,
  RUNSTONE_QUAD_WIDTH_BITS = 7,
  RUNSTONE_QUAD_HEIGHT_SHIFT = 28,
  RUNSTONE_QUAD_HEIGHT_BITS = 7,
  RUNSTONE_QUAD_DIRECTION_SHIFT = 35,
  RUNSTONE_QUAD_DIRECTION_BITS = 3,
  RUNSTONE_QUAD_MATERIAL_SHIFT = 38,
  RUNSTONE_QUAD_MATERIAL_BITS = 16,
  RUNSTONE_QUAD_FACE_SHIFT = 54,
  RUNSTONE_QUAD_FACE_BITS = 10
};

typedef struct runstone_chunk runstone_chunk;   /* voxels as runs */
typedef struct runstone_edits runstone_edits;   /* edits, in the order in which they are applied */
typedef struct runstone_shapes runstone_shapes; /* the shapes of materials that are no cubes */
typedef struct runstone_visibility runstone_visibility; /* how each material is drawn */
typedef struct runstone_borders
    runstone_borders; /* the outermost layers of a chunk, for its neighbours */
typedef struct runstone_mesh runstone_mesh;     /* quads of a chunk */
typedef struct runstone_space runstone_space;   /* chunks of a world, for collision */
typedef struct runstone_client runstone_client; /* a player in the world of a server */

typedef struct runstone_pos {
  int32_t x, y, z;
} runstone_pos; /* a voxel or a chunk */
typedef struct runstone_box {
  runstone_pos min, max;
} runstone_box; /* half-open, voxels */
typedef struct runstone_vec {
  double x, y, z;
} runstone_vec; /* voxels */
typedef struct runstone_body {
  runstone_vec min, max;
} runstone_body; /* a box that moves; max - min is above 2e-6 voxels on each axis */
typedef struct runstone_local_box {
  uint8_t min[3], max[3];
} runstone_local_box; /* half-open, in a chunk */

typedef struct runstone_chunk_info {
  uint32_t struct_size;
  uint32_t sides[3]; /* voxels along x, y and z */
  uint32_t order;    /* RUNSTONE_ORDER_... */
  uint32_t volume;   /* voxels */
  uint32_t runs;
  uint32_t is_uniform; /* 1 if all voxels have one material */
} runstone_chunk_info;

typedef struct runstone_brush {
  uint32_t struct_size;
  uint32_t mask;          /* RUNSTONE_MASK_...: the voxels that may change */
  uint16_t mask_material; /* for ONLY_MATERIAL; otherwise 0 */
  uint16_t material;      /* what they become; 0 removes them */
} runstone_brush;

typedef struct runstone_changes {
  uint32_t struct_size;
  uint32_t is_changed; /* 1 if a voxel has another material than before */
  uint64_t voxels;     /* the number of these voxels */
  uint8_t layers
      [3][16]; /* the layers with such a voxel: along axis a, layer l is bit l % 8 of [a][l / 8] */
} runstone_changes;

typedef struct runstone_quad_fields {
  uint32_t struct_size;
  uint32_t x, y, z;       /* voxel of the corner with the smallest coordinates */
  uint32_t width, height; /* faces along u and v, 1 .. 128 */
  /* (u, v) is (y, z) for direction x, (z, x) for y, (x, y) for z */
  uint32_t direction;
  uint32_t material;
  uint32_t face; /* 0 for a cube; otherwise face - 1 of the material's shape */
} runstone_quad_fields;

typedef struct runstone_vertex { /* 36 bytes, for a vertex buffer */
  float position[3];             /* in the chunk, 0 .. 128 */
  float normal[3];
  float uv[2]; /* counts faces along u and v, so that a texture repeats once a voxel */
  uint16_t material;
  uint16_t occlusion; /* 0 .. 3, darkest; 0 without runstone_mesh_occlude() */
} runstone_vertex;

typedef struct runstone_sweep {
  uint32_t struct_size;
  uint32_t is_hit;
  double fraction;    /* of the move that is possible, 0 .. 1 */
  uint32_t direction; /* of the face that was hit, towards the body; NONE if the way is free */
  runstone_pos voxel; /* one of those that were hit */
} runstone_sweep;

typedef struct runstone_slide {
  uint32_t struct_size;
  uint32_t stopped; /* bit d: the move in direction d met a solid voxel */
  runstone_vec moved;
} runstone_slide;

typedef struct runstone_ray {
  uint32_t struct_size;
  uint32_t is_hit;
  double distance;    /* to the face, voxels */
  uint32_t direction; /* of the face; NONE if the ray begins inside the voxel or hits nothing */
  runstone_pos voxel;
  uint32_t material;
  uint32_t reserved; /* 0 */
} runstone_ray;

/* Versions and errors. These do not fail. */

/* Returns RUNSTONE_ABI of the library. */
RUNSTONE_API uint32_t runstone_abi(void);
/* Returns the version of Runstone as MAJOR.MINOR.PATCH. */
RUNSTONE_API const char* runstone_version(void);
/* Returns the words of the last refusal in this thread, or "" if there was none. They stay until
 * the thread's next refusal. */
RUNSTONE_API const char* runstone_last_error(void);
/* Returns the name of a status, for example "truncated", or "unknown status". */
RUNSTONE_API const char* runstone_status_name(runstone_status status);

/* Chunks. Sides outside 8 .. 128 are refused. */

/* Makes a chunk of one material. */
RUNSTONE_API runstone_status runstone_chunk_create_filled(uint32_t side_x, uint32_t side_y,
                                                          uint32_t side_z, uint16_t material,
                                                          runstone_chunk** out);
/* Makes a chunk of an array with a material for each voxel, flattened in `order`. `count` is the
 * volume. Cost: O(volume). */
RUNSTONE_API runstone_status runstone_chunk_create_from_array(uint32_t side_x, uint32_t side_y,
                                                              uint32_t side_z, uint32_t order,
                                                              const uint16_t* voxels, size_t count,
                                                              runstone_chunk** out);
/* Makes a chunk of runs: run i ends before voxel ends[i] of the chunk flattened in `order`. Ends
 * ascend, the last one is the volume, and neighbours differ in material. Cost: O(runs). */
RUNSTONE_API runstone_status runstone_chunk_create_from_runs(uint32_t side_x, uint32_t side_y,
                                                             uint32_t side_z, uint32_t order,
                                                             const uint32_t* ends,
                                                             const uint16_t* materials,
                                                             size_t count, runstone_chunk** out);
RUNSTONE_API runstone_status runstone_chunk_clone(const runstone_chunk* chunk,
                                                  runstone_chunk** out);
RUNSTONE_API runstone_status runstone_chunk_free(runstone_chunk* chunk);
RUNSTONE_API runstone_status runstone_chunk_get_info(const runstone_chunk* chunk,
                                                     runstone_chunk_info* out);
/* Gives the material of one voxel. Cost: O(log runs). */
RUNSTONE_API runstone_status runstone_chunk_get(const runstone_chunk* chunk, uint32_t x, uint32_t y,
                                                uint32_t z, uint16_t* material);
/* Sets voxels [first, first + voxels) of the chunk, flattened in its own order. */
RUNSTONE_API runstone_status runstone_chunk_fill(runstone_chunk* chunk, uint32_t first,
                                                 uint32_t voxels, uint16_t material);
/* Writes all voxels, flattened in `order`. Cost: O(volume). */
RUNSTONE_API runstone_status runstone_chunk_to_array(const runstone_chunk* chunk, uint32_t order,
                                                     uint16_t* out, size_t capacity, size_t* count);
/* Writes the runs as runstone_chunk_create_from_runs() takes them, to two arrays of one capacity. */
RUNSTONE_API runstone_status runstone_chunk_runs(const runstone_chunk* chunk, uint32_t* ends,
                                                 uint16_t* materials, size_t capacity,
                                                 size_t* count);
/* Changes the axis order and no voxel. Fewer runs are meshed faster and take less memory. */
RUNSTONE_API runstone_status runstone_chunk_reorder(runstone_chunk* chunk, uint32_t order);
/* Gives the digest of the voxels, two numbers. It does not depend on the axis order. It detects
 * drift between two holders of the same voxels and is not cryptographic. */
RUNSTONE_API runstone_status runstone_chunk_digest(const runstone_chunk* chunk, uint64_t digest[2]);
/* Gives 1 if sides and voxels are equal, in whatever axis orders, otherwise 0. */
RUNSTONE_API runstone_status runstone_chunk_equal(const runstone_chunk* a, const runstone_chunk* b,
                                                  uint32_t* is_equal);

/* Chunk bytes, as on disk and on the wire (docs/protocol.md). runstone_runs.h reads raw ones
 * without a library. */

RUNSTONE_API runstone_status runstone_chunk_encode(const runstone_chunk* chunk, uint32_t encoding,
                                                   uint8_t* out, size_t capacity, size_t* count);
/* Makes a chunk of bytes of any encoding. Accepts one spelling of each chunk only, and bounds the
 * memory that bytes can cost. `sides` is NULL or the sides that the chunk must have; others are
 * refused before memory is used. */
RUNSTONE_API runstone_status runstone_chunk_decode(const uint8_t* bytes, size_t count,
                                                   const uint32_t sides[3], runstone_chunk** out);

/* Edits. A list has any number of edits. Each is checked when it is added. `index` counts from 0. */

RUNSTONE_API runstone_status runstone_edits_create(runstone_edits** out);
RUNSTONE_API runstone_status runstone_edits_free(runstone_edits* edits);
RUNSTONE_API runstone_status runstone_edits_clear(runstone_edits* edits);
RUNSTONE_API runstone_status runstone_edits_count(const runstone_edits* edits, size_t* count);
RUNSTONE_API runstone_status runstone_edits_add_voxel(runstone_edits* edits, runstone_pos at,
                                                      const runstone_brush* brush);
/* Adds a box, not empty, of at most 4096 voxels along each axis. */
RUNSTONE_API runstone_status runstone_edits_add_box(runstone_edits* edits, runstone_box box,
                                                    const runstone_brush* brush);
/* Adds a ball of radius 0 .. 512: the voxels whose offset d from the centre has |d| < radius +
 * 1/2. */
RUNSTONE_API runstone_status runstone_edits_add_sphere(runstone_edits* edits, runstone_pos centre,
                                                       uint32_t radius,
                                                       const runstone_brush* brush);
/* Adds a ball of radius 1 .. 512 that is drawn along 2 .. 256 points. */
RUNSTONE_API runstone_status runstone_edits_add_stroke(runstone_edits* edits,
                                                       const runstone_pos* points, size_t count,
                                                       uint32_t radius,
                                                       const runstone_brush* brush);
/* Adds one edit from its canonical bytes (docs/edit-log.md), such as a paste. */
RUNSTONE_API runstone_status runstone_edits_add_bytes(runstone_edits* edits, const uint8_t* bytes,
                                                      size_t count);
/* Writes the canonical bytes of an edit. */
RUNSTONE_API runstone_status runstone_edits_bytes(const runstone_edits* edits, size_t index,
                                                  uint8_t* out, size_t capacity, size_t* count);
/* Gives the smallest box that holds the geometry of an edit. */
RUNSTONE_API runstone_status runstone_edits_bounds(const runstone_edits* edits, size_t index,
                                                   runstone_box* bounds);
/* Writes the chunks in which the geometry of an edit has a voxel, ascending by x, y, z. Refuses
 * an edit that may touch more than 1,048,576 chunks. `edge` is 16, 32, 64 or 128. */
RUNSTONE_API runstone_status runstone_edits_touched_chunks(const runstone_edits* edits,
                                                           size_t index, uint32_t edge,
                                                           runstone_pos* out, size_t capacity,
                                                           size_t* count);
/* Applies all edits to the chunk of a world whose place in the grid of chunks is `at`: its first
 * voxel is at * edge. The chunk must be a cube of edge 16, 32, 64 or 128. Edits that miss it do
 * nothing. `changes` may be NULL. */
RUNSTONE_API runstone_status runstone_chunk_apply(runstone_chunk* chunk, runstone_pos at,
                                                  const runstone_edits* edits,
                                                  runstone_changes* changes);

/* Shapes. Materials without a shape are cubes. A shape is one of boxes in sixteenths of a voxel. */

RUNSTONE_API runstone_status runstone_shapes_create(runstone_shapes** out);
RUNSTONE_API runstone_status runstone_shapes_free(runstone_shapes* shapes);
/* Gives a material the shape of 1 to 32 boxes: their union, or the two upright diagonal planes of
 * each for RUNSTONE_SHAPE_CROSSED, which are plants. min is 0 .. 15, and max is min + 1 .. 16.
 * Replaces the present shape of the material, if any. Refuses more than 1023 faces. */
RUNSTONE_API runstone_status runstone_shapes_add(runstone_shapes* shapes, uint16_t material,
                                                 uint32_t form, const runstone_local_box* boxes,
                                                 size_t count);
/* Gives a material the shape of a kind, such as "stairs" with the states "facing=east,half=top"
 * (docs/materials.md). States that are missing or unknown have their defaults, and `states` may be
 * NULL. States that make a cube, such as "type=double" of a slab, remove the shape. */
RUNSTONE_API runstone_status runstone_shapes_add_kind(runstone_shapes* shapes, uint16_t material,
                                                      const char* kind, const char* states);

/* Meshes. A face belongs to the chunk of its solid voxel. */

/* visibilities[i] is RUNSTONE_EMPTY, OPAQUE or TRANSPARENT for material i. Materials without an
 * entry are opaque; material 0 is always empty. */
RUNSTONE_API runstone_status runstone_visibility_create(const uint8_t* visibilities, size_t count,
                                                        runstone_visibility** out);
/* Makes a table in which materials have shapes. Meshes that are made with this table have quads of
 * shapes. Levels of detail treat a shape as a cube if it fills at least half of its voxel. The
 * shapes are copied. */
RUNSTONE_API runstone_status runstone_visibility_create_with_shapes(const uint8_t* visibilities,
                                                                    size_t count,
                                                                    const runstone_shapes* shapes,
                                                                    runstone_visibility** out);
RUNSTONE_API runstone_status runstone_visibility_free(runstone_visibility* visibility);
/* Keeps the outermost layers of a chunk as it is now, so that its neighbours are meshed without
 * its runs. */
RUNSTONE_API runstone_status runstone_borders_create(const runstone_chunk* chunk,
                                                     const runstone_visibility* visibility,
                                                     runstone_borders** out);
RUNSTONE_API runstone_status runstone_borders_free(runstone_borders* borders);
/* Makes a mesh without quads. */
RUNSTONE_API runstone_status runstone_mesh_create(runstone_mesh** out);
RUNSTONE_API runstone_status runstone_mesh_free(runstone_mesh* mesh);
/* Meshes a chunk. `neighbours` is NULL or six chunks by direction, of which each may be NULL: its
 * voxels then count as empty. Neighbours have the chunk's sides where they touch. `borders` is
 * NULL or six borders by direction, of which each may be NULL; a border must be of the neighbour
 * as it is now and of the same visibility. */
RUNSTONE_API runstone_status runstone_mesh_chunk(runstone_mesh* mesh, const runstone_chunk* chunk,
                                                 const runstone_chunk* const neighbours[6],
                                                 const runstone_borders* const borders[6],
                                                 const runstone_visibility* visibility);
/* Brings a mesh up to date with the same quads as runstone_mesh_chunk(). Meshes only the layers
 * that runstone_chunk_apply() changed since the mesh was made, in the chunk and beside it in the
 * neighbours, where that costs less. Clones of a chunk continue its changes. `is_whole`, if not
 * NULL, becomes 1 if all was meshed. */
RUNSTONE_API runstone_status runstone_mesh_update(runstone_mesh* mesh, const runstone_chunk* chunk,
                                                  const runstone_chunk* const neighbours[6],
                                                  const runstone_borders* const borders[6],
                                                  const runstone_visibility* visibility,
                                                  uint32_t* is_whole);
/* Darkens the corners of the quads of cubes by the opaque voxels around them. Quads are cut so that
 * the four corners of each quad give the exact values of each of its faces. Vertices then have
 * their occlusion. `around` is NULL or 27 chunks, each of which may be NULL. The chunk at the
 * offsets x, y and z, each -1, 0 or 1, is around[x + 1 + 3 * (y + 1) + 9 * (z + 1)]. around[13] is
 * not read. Refuses a mesh that was not made from this chunk, these neighbours and this visibility
 * as they are now. The next runstone_mesh_chunk() or runstone_mesh_update() removes the
 * occlusion. */
RUNSTONE_API runstone_status runstone_mesh_occlude(runstone_mesh* mesh, const runstone_chunk* chunk,
                                                   const runstone_chunk* const around[27],
                                                   const runstone_visibility* visibility);
/* Writes the occlusion of the corners of each quad of a pass, for programs that unpack quads in a
 * shader: bits 2 * i and 2 * i + 1 are the occlusion of corner i. Corners are in the order of the
 * vertices of a quad without occlusion. Writes zeros if runstone_mesh_occlude() was not called. */
RUNSTONE_API runstone_status runstone_mesh_occlusion(const runstone_mesh* mesh, uint32_t pass,
                                                     uint8_t* out, size_t capacity, size_t* count);
/* Writes the quads of cubes of a pass, 8 bytes each (docs/meshing.md), by direction, then layer. */
RUNSTONE_API runstone_status runstone_mesh_quads(const runstone_mesh* mesh, uint32_t pass,
                                                 uint64_t* out, size_t capacity, size_t* count);
/* Writes the quads of one direction and layer, 0 .. 127, so that a vertex buffer can be replaced
 * in part. */
RUNSTONE_API runstone_status runstone_mesh_layer_quads(const runstone_mesh* mesh, uint32_t pass,
                                                       uint32_t direction, uint32_t layer,
                                                       uint64_t* out, size_t capacity,
                                                       size_t* count);
/* Writes four vertices for each quad of cubes of a pass, counter-clockwise seen from outside. A
 * quad with occlusion may begin at its second corner, so that the triangles of
 * runstone_mesh_indices() meet at the diagonal that is less dark. */
RUNSTONE_API runstone_status runstone_mesh_vertices(const runstone_mesh* mesh, uint32_t pass,
                                                    runstone_vertex* out, size_t capacity,
                                                    size_t* count);
/* Writes six indices for each quad of cubes of a pass: two triangles of its four vertices. */
RUNSTONE_API runstone_status runstone_mesh_indices(const runstone_mesh* mesh, uint32_t pass,
                                                   uint32_t* out, size_t capacity, size_t* count);
/* Writes the quads of shapes of a pass by direction. Their `face` is not 0. */
RUNSTONE_API runstone_status runstone_mesh_shape_quads(const runstone_mesh* mesh, uint32_t pass,
                                                       uint64_t* out, size_t capacity,
                                                       size_t* count);
/* Writes four vertices for each quad of shapes of a pass, counter-clockwise seen from its side. The
 * planes of plants have a quad for each side. */
RUNSTONE_API runstone_status runstone_mesh_shape_vertices(const runstone_mesh* mesh, uint32_t pass,
                                                          runstone_vertex* out, size_t capacity,
                                                          size_t* count);
/* Writes six indices for each quad of shapes of a pass. */
RUNSTONE_API runstone_status runstone_mesh_shape_indices(const runstone_mesh* mesh, uint32_t pass,
                                                         uint32_t* out, size_t capacity,
                                                         size_t* count);
/* Unpacks a quad that a mesh gave. */
RUNSTONE_API runstone_status runstone_quad_unpack(uint64_t quad, runstone_quad_fields* out);

/* Levels of detail (docs/tiles.md). */

/* Makes the tile of eight children, of which each may be NULL: empty. Child i lies at x = i & 1,
 * y = i >> 1 & 1, z = i >> 2. They are cubes of `edge` 16, 32, 64 or 128, as is the tile. */
RUNSTONE_API runstone_status runstone_tile_build(const runstone_chunk* const children[8],
                                                 uint32_t edge, uint32_t order,
                                                 const runstone_visibility* visibility,
                                                 runstone_chunk** out);
/* Replaces the materials of enclosed voxels of a tile so that it has fewer runs. No face that is
 * drawn changes. */
RUNSTONE_API runstone_status runstone_tile_veil(runstone_chunk* tile,
                                                const runstone_visibility* visibility);

/* Collision. A space holds copies of chunks. Chunks that were not set are not known. They stop
 * bodies, unless runstone_space_set_solid() says otherwise, and rays end there without a hit. */

RUNSTONE_API runstone_status runstone_space_create(uint32_t edge, runstone_space** out);
RUNSTONE_API runstone_status runstone_space_free(runstone_space* space);
/* Sets the chunk at a place in the grid of chunks, a cube of the space's edge. NULL forgets it. */
RUNSTONE_API runstone_status runstone_space_set(runstone_space* space, runstone_pos at,
                                                const runstone_chunk* chunk);
/* Says which materials stop bodies and rays: material i does if solid[i] is not 0. Material 0 is
 * empty, so solid[0] must be 0. `others` says it for the other materials without an entry. It also
 * says if chunks that are not known stop bodies; rays always end there. At first every material but
 * 0 stops, and so does every chunk that is not known. */
RUNSTONE_API runstone_status runstone_space_set_solid(runstone_space* space, const uint8_t* solid,
                                                      size_t count, uint32_t others);
/* Moves a box until it meets a solid voxel. Body and move have at most 256 voxels along each
 * axis. */
RUNSTONE_API runstone_status runstone_space_sweep(const runstone_space* space, runstone_body body,
                                                  runstone_vec move, runstone_sweep* out);
/* Moves a box and goes on along the other axes where it meets a solid voxel. */
RUNSTONE_API runstone_status runstone_space_slide(const runstone_space* space, runstone_body body,
                                                  runstone_vec move, runstone_slide* out);
/* Gives 1 if a solid voxel overlaps the box, otherwise 0. */
RUNSTONE_API runstone_status runstone_space_overlaps(const runstone_space* space,
                                                     runstone_body body, uint32_t* overlaps);
/* Finds the first solid voxel along a ray of 0 .. 512 voxels. `direction` may have any length but
 * 0. Numbers that are not finite are refused. */
RUNSTONE_API runstone_status runstone_space_pick(const runstone_space* space, runstone_vec eye,
                                                 runstone_vec direction, double reach,
                                                 runstone_ray* out);
/* Writes boxes that cover each solid voxel of a chunk exactly once and no other voxel, for
 * physics engines. `solid` and `others` are as in runstone_space_set_solid(). */
RUNSTONE_API runstone_status runstone_chunk_boxes(const runstone_chunk* chunk, const uint8_t* solid,
                                                  size_t solid_count, uint32_t others,
                                                  runstone_local_box* out, size_t capacity,
                                                  size_t* count);

/* The client (docs/c.md#the-client). A client joins a server and keeps the chunks around a player
 * up to date. A program calls runstone_client_step() every frame, drains the events and meshes the
 * chunks that they name. So no mesh stays out of date.
 *
 * Threads. The calls of one client are made by one thread at a time, also those that only read. No
 * call waits for the network or a disk, except _connect() with files, _wait(), _close(), _free(),
 * and the _step() that saves the key of a new server in a file.
 *
 * A build of the library without the client has these functions, too. There,
 * runstone_client_connect() returns RUNSTONE_UNSUPPORTED. */

enum {
  RUNSTONE_ENCRYPTION_ANY_CERTIFICATE = 0, /* TLS 1.3; the handshake proves the server's key */
  RUNSTONE_ENCRYPTION_AUTHORITIES = 1,     /* TLS 1.3 with a certificate of an authority */
  RUNSTONE_ENCRYPTION_NONE = 2             /* for servers that run with --insecure */
};
enum {
  RUNSTONE_CLIENT_CONNECTING = 0, /* there is no open world; attempts to connect go on */
  RUNSTONE_CLIENT_OPEN = 1,
  RUNSTONE_CLIENT_ENDED = 2 /* closed, or refused by the server for good */
};
/* The action of the first edit of a new action, for runstone_client_submit(). */
#define RUNSTONE_NEW_ACTION UINT64_MAX

/* Kinds of events. Later libraries may have more kinds: ignore unknown ones. */
enum {
  /* The world is open. flags: RUNSTONE_FLAG_ANOTHER_WORLD, RUNSTONE_FLAG_FIRST_CONTACT */
  RUNSTONE_EVENT_WORLD_OPENED = 1,
  /* A connection ended or could not be made. text: a sentence; more: the exact reason. flags:
   * RUNSTONE_FLAG_FINAL, RUNSTONE_FLAG_LACKS_PASSWORD */
  RUNSTONE_EVENT_CONNECTION_LOST = 2,
  /* The mesh of a chunk is out of date or missing. at; detail: RUNSTONE_CAUSE_... */
  RUNSTONE_EVENT_CHUNK_CHANGED = 3,
  RUNSTONE_EVENT_CHUNK_REMOVED = 4,  /* A chunk is not shown any more: remove its mesh. at */
  RUNSTONE_EVENT_CHUNK_MISSING = 5,  /* The server cannot send a chunk. at */
  RUNSTONE_EVENT_EDIT_CONFIRMED = 6, /* The server ordered an edit. edit, sequence */
  /* The server rejected an edit, which is not shown any more. edit; text: words for the player;
   * more: the name of the reason (docs/protocol.md) */
  RUNSTONE_EVENT_EDIT_REJECTED = 7,
  RUNSTONE_EVENT_EDIT_DURABLE = 8, /* An edit is on the disk of the server. edit */
  /* An edit is resolved, but the answer was lost with a connection. edit */
  RUNSTONE_EVENT_EDIT_UNSEEN = 9,
  /* An edit of another author changed chunks of the view. author, sequence; chunks:
   * runstone_client_event_chunks() */
  RUNSTONE_EVENT_OTHERS_EDIT = 10,
  /* A line of the chat. detail: RUNSTONE_CHAT_...; text; more: the name of a player; utc_us */
  RUNSTONE_EVENT_CHAT = 11,
  /* A command ended. flags: RUNSTONE_FLAG_OK, RUNSTONE_FLAG_ANSWER_LOST; text: its lines */
  RUNSTONE_EVENT_COMMAND_DONE = 12,
  RUNSTONE_EVENT_MATERIALS_CHANGED = 13, /* There are more materials, or other shapes. */
  RUNSTONE_EVENT_PLAYERS_CHANGED = 14,   /* Players joined, left or changed their name or role. */
  /* An option cannot be honoured, for example the cache, and the client goes on. text */
  RUNSTONE_EVENT_WARNING = 15
};
enum { /* flags of events */
       RUNSTONE_FLAG_ANOTHER_WORLD =
           1, /* another world than before is open; all earlier chunks are removed */
       RUNSTONE_FLAG_FIRST_CONTACT = 2,  /* the key of the server was not known */
       RUNSTONE_FLAG_FINAL = 4,          /* the client does not connect again */
       RUNSTONE_FLAG_LACKS_PASSWORD = 8, /* the world has a password, and the options have none */
       RUNSTONE_FLAG_OK = 16,
       RUNSTONE_FLAG_ANSWER_LOST = 32 /* the command may have been carried out */
};
enum { /* why a chunk changed */
       RUNSTONE_CAUSE_TERRAIN = 0,
       RUNSTONE_CAUSE_OTHERS_EDIT = 1,
       RUNSTONE_CAUSE_OWN_EDIT = 2
};
enum { /* who wrote a line of the chat */
       RUNSTONE_CHAT_PLAYER = 0,
       RUNSTONE_CHAT_SERVER = 1,
       RUNSTONE_CHAT_MESSAGE_OF_THE_DAY = 2,
       RUNSTONE_CHAT_REFUSED = 3, /* the server rejected a line of this client; text: the reason */
       RUNSTONE_CHAT_VISIT = 4,   /* a player has joined or left */
       RUNSTONE_CHAT_OTHER = 5    /* a kind of a newer server */
};

typedef struct runstone_client_options {
  uint32_t struct_size;
  uint32_t encryption; /* RUNSTONE_ENCRYPTION_... */
  /* Texts may be NULL, which is the default in brackets. */
  const char* server;            /* HOST, HOST:PORT or a link runstone://... (refused) */
  const char* name;              /* of the player, 1 to 32 bytes ("builder") */
  const char* invite;            /* a token (that of the link) */
  const char* password;          /* of the world (none) */
  const char* key_file;          /* of the player's identity, made if missing (not kept) */
  const uint8_t* key_seed;       /* 32 bytes, used without a key file (random) */
  const char* authorities_file;  /* PEM (those of the system) */
  const char* cache_folder;      /* where chunks are kept between runs (not kept) */
  uint32_t view_radius;          /* chunks around the player, 0 to 64 (8) */
  uint32_t view_radius_vertical; /* (4) */
  uint64_t memory_mib;           /* of chunks and edits, 16 to 65536 (1024) */
  uint64_t cache_mib;            /* 1 to 1048576 (256) */
  /* A thread of the library calls this function when runstone_client_step() has something to do.
   * The function must not call the client, nor wait for a thread that may be in a call of the
   * client, for example for a mutex (NULL). */
  void (*wake)(void* context);
  void* wake_context;
} runstone_client_options;

typedef struct runstone_event {
  uint32_t struct_size;
  uint32_t kind;     /* RUNSTONE_EVENT_... */
  uint32_t flags;    /* RUNSTONE_FLAG_... */
  uint32_t detail;   /* RUNSTONE_CAUSE_... or RUNSTONE_CHAT_... */
  runstone_pos at;   /* a chunk */
  uint32_t author;   /* 0: the server */
  uint64_t edit;     /* the number of an edit of this client */
  uint64_t sequence; /* in the log of the world */
  int64_t utc_us;    /* microseconds since 1970 */
} runstone_event;

typedef struct runstone_place { /* 40 bytes */
  runstone_vec at;              /* of the eye */
  double yaw_degrees;           /* 0 looks along +z, and grows towards +x */
  double pitch_degrees;         /* -90 .. 90; positive looks up */
} runstone_place;

typedef struct runstone_world_info {
  uint32_t struct_size;
  uint32_t chunk_edge;      /* voxels */
  int32_t y_min, y_max;     /* edits may cover voxels with y_min <= y < y_max */
  uint64_t edit_volume_max; /* voxels of an edit */
  runstone_vec spawn;
  uint8_t id[16];
  uint32_t author;       /* this player */
  char name[36];         /* of this player */
  char fingerprint[136]; /* of the server's key, to be compared by people; cut if it is longer */
} runstone_world_info;

typedef struct runstone_material_info {
  uint32_t struct_size;
  uint32_t visibility; /* RUNSTONE_EMPTY, OPAQUE or TRANSPARENT */
  uint32_t is_cube;    /* 0: it has a shape */
  uint8_t colour[4];   /* sRGB and alpha */
  char name[68];
} runstone_material_info;

typedef struct runstone_player { /* 120 bytes */
  uint32_t author;
  uint32_t has_place; /* 0: it is not known where the player is */
  runstone_place place;
  char name[36];
  char role[36]; /* "" if the server did not name it; cut if it is longer */
} runstone_player;

/* Fills options with their defaults. Requires that the caller has set out->struct_size. */
RUNSTONE_API runstone_status runstone_client_default_options(runstone_client_options* out);
/* Starts to connect and returns at once. An event reports the outcome. After a loss the client
 * connects again by itself. Refuses invalid options, and files that cannot be used. Copies the
 * texts of the options. */
RUNSTONE_API runstone_status runstone_client_connect(const runstone_client_options* options,
                                                     runstone_client** out);
/* Closes the client as runstone_client_close() does, and frees it. */
RUNSTONE_API runstone_status runstone_client_free(runstone_client* client);
/* Sends the queued messages and a goodbye, and ends the threads. Waits at most a second for the
 * network, and until the cache is written. Chunks and events stay readable. A second call does
 * nothing. */
RUNSTONE_API runstone_status runstone_client_close(runstone_client* client);
/* Handles received messages and sends due ones. Call it every frame, or every 10 ms. A call takes a
 * few milliseconds at most. The call that joins with a password takes a quarter of a second.
 * `has_more`, if not NULL, becomes 1 if messages are left for the next call, otherwise 0. */
RUNSTONE_API runstone_status runstone_client_step(runstone_client* client, uint32_t* has_more);
/* Waits until runstone_client_step() has something to do, at most `milliseconds`. */
RUNSTONE_API runstone_status runstone_client_wait(runstone_client* client, uint32_t milliseconds);
/* Writes the next events to an array of `capacity` elements of `event_size` bytes, which is
 * sizeof(runstone_event), and their number to *count. Events that do not fit are kept, so a program
 * calls again while *count is the capacity. A call takes at most `chunks_max` of the changed
 * chunks, the most important ones. The other chunks stay outdated until a later call. Events that
 * an earlier call kept come first, and `chunks_max` does not limit them. The index of an event
 * names it until the next call. Requires a capacity of at least 1. */
RUNSTONE_API runstone_status runstone_client_drain(runstone_client* client, size_t chunks_max,
                                                   runstone_event* out, size_t event_size,
                                                   size_t capacity, size_t* count);
/* These two calls write the texts of a drained event. *count includes the zero at the end. */
RUNSTONE_API runstone_status runstone_client_event_text(runstone_client* client, size_t index,
                                                        char* out, size_t capacity, size_t* count);
RUNSTONE_API runstone_status runstone_client_event_more(runstone_client* client, size_t index,
                                                        char* out, size_t capacity, size_t* count);
/* Writes the chunks of a drained RUNSTONE_EVENT_OTHERS_EDIT. */
RUNSTONE_API runstone_status runstone_client_event_chunks(runstone_client* client, size_t index,
                                                          runstone_pos* out, size_t capacity,
                                                          size_t* count);
/* Makes handles of the chunk of a drained RUNSTONE_EVENT_CHUNK_CHANGED, and of its six neighbours
 * if `neighbours` is not NULL. Handles of missing neighbours become NULL. The caller frees the
 * handles. They are copies, which any thread may mesh. */
RUNSTONE_API runstone_status runstone_client_take_chunk(runstone_client* client, size_t index,
                                                        runstone_chunk** chunk,
                                                        runstone_chunk* neighbours[6]);
/* Meshes the chunk of a drained RUNSTONE_EVENT_CHUNK_CHANGED with the materials and shapes of the
 * world, without copies of chunks. */
RUNSTONE_API runstone_status runstone_client_mesh(runstone_client* client, size_t index,
                                                  runstone_mesh* mesh);
/* Gives the number of chunks that have to be meshed and were not drained yet. */
RUNSTONE_API runstone_status runstone_client_outdated(runstone_client* client, size_t* count);
/* Gives the state, RUNSTONE_CLIENT_.... `is_complete`, if not NULL, becomes 1 if all chunks around
 * the player have arrived, otherwise 0. */
RUNSTONE_API runstone_status runstone_client_state(runstone_client* client, uint32_t* state,
                                                   uint32_t* is_complete);
/* Describes the world. Returns RUNSTONE_NOT_FOUND before a world was open for the first time. */
RUNSTONE_API runstone_status runstone_client_world(runstone_client* client,
                                                   runstone_world_info* out);
/* Moves the player, and the view with it. */
RUNSTONE_API runstone_status runstone_client_move(runstone_client* client,
                                                  const runstone_place* place);
/* Gives the place of the player: the place of the last move, or the place where the server let the
 * player begin. */
RUNSTONE_API runstone_status runstone_client_place(runstone_client* client, runstone_place* out);
RUNSTONE_API runstone_status runstone_client_set_view(runstone_client* client, uint32_t radius,
                                                      uint32_t radius_vertical);
/* Shows edit `index` of a list at once and sends it. An event reports the outcome of the edit with
 * this `number`, also after a lost connection, unless the client ends before. One undo takes back
 * all edits of one action. Pass RUNSTONE_NEW_ACTION with the first edit of an action, and the
 * number of the first edit with the others. With 0 the edit is an action by itself. Returns
 * RUNSTONE_LIMIT_EXCEEDED if the budget of the player does not suffice yet. `number` may be
 * NULL. */
RUNSTONE_API runstone_status runstone_client_submit(runstone_client* client,
                                                    const runstone_edits* edits, size_t index,
                                                    uint64_t action, uint64_t* number);
/* Gives the microseconds until the budget of the player suffices for an edit, or 0 if it suffices
 * now. */
RUNSTONE_API runstone_status runstone_client_submit_delay(runstone_client* client,
                                                          const runstone_edits* edits, size_t index,
                                                          int64_t* wait_us);
/* Sends a line of the chat to all players. */
RUNSTONE_API runstone_status runstone_client_chat(runstone_client* client, const char* line);
/* Sends a command, such as "undo". RUNSTONE_EVENT_COMMAND_DONE has the answer. Refuses another
 * command before that event was drained. */
RUNSTONE_API runstone_status runstone_client_command(runstone_client* client, const char* text);
/* Makes a handle of a chunk that is shown. The caller frees it. */
RUNSTONE_API runstone_status runstone_client_chunk(runstone_client* client, runstone_pos at,
                                                   runstone_chunk** out);
/* Writes the places of the chunks that are shown, ascending. */
RUNSTONE_API runstone_status runstone_client_chunks(runstone_client* client, runstone_pos* out,
                                                    size_t capacity, size_t* count);
/* Gives the material of a voxel that is shown. */
RUNSTONE_API runstone_status runstone_client_material_at(runstone_client* client,
                                                         runstone_pos voxel, uint16_t* material);
/* Gives the number of materials, or 0 before a world was open. Materials are 0 .. count - 1. */
RUNSTONE_API runstone_status runstone_client_material_count(runstone_client* client, size_t* count);
RUNSTONE_API runstone_status runstone_client_material(runstone_client* client, uint32_t material,
                                                      runstone_material_info* out);
RUNSTONE_API runstone_status runstone_client_find_material(runstone_client* client,
                                                           const char* name, uint16_t* material);
/* Makes a table of the materials and shapes of the world as they are now. The caller frees it. */
RUNSTONE_API runstone_status runstone_client_visibility(runstone_client* client,
                                                        runstone_visibility** out);
/* Writes the other players in the world, ascending by author. */
RUNSTONE_API runstone_status runstone_client_players(runstone_client* client, runstone_player* out,
                                                     size_t capacity, size_t* count);

#ifdef __cplusplus
}
#endif
#endif
