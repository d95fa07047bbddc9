/* runstone.h: the C interface of Runstone's libraries: chunks of runs, their bytes, edits, quads,
 * levels of detail and collision. docs/c.md has a program, and the rules below in full.
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
  RUNSTONE_NOT_FOUND = 10,
  RUNSTONE_IO_FAILED = 11,     /* reserved: no call returns it */
  RUNSTONE_NOT_PERMITTED = 12, /* reserved: no call returns it */
  RUNSTONE_BAD_ARGUMENT =
      13, /* NULL, a number out of range, or handles that do not belong together */
  RUNSTONE_BAD_HANDLE = 14,       /* a handle of another kind, or one that was freed */
  RUNSTONE_BUFFER_TOO_SMALL = 15, /* *count says how many elements are needed */
  RUNSTONE_NO_MEMORY = 16,
  RUNSTONE_DAMAGED = 17, /* memory ran out while the handle was changed: only free it */
  RUNSTONE_INTERNAL = 18 /* a defect of the library */
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

typedef struct runstone_chunk runstone_chunk; /* voxels as runs */
typedef struct runstone_edits runstone_edits; /* edits, in the order in which they are applied */
typedef struct runstone_visibility runstone_visibility; /* how each material is drawn */
typedef struct runstone_borders
    runstone_borders; /* the outermost layers of a chunk, for its neighbours */
typedef struct runstone_mesh runstone_mesh;   /* quads of a chunk */
typedef struct runstone_space runstone_space; /* chunks of a world, for collision */

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
} runstone_quad_fields;

typedef struct runstone_vertex { /* 36 bytes, for a vertex buffer */
  float position[3];             /* in the chunk, 0 .. 128 */
  float normal[3];
  float uv[2]; /* counts faces along u and v, so that a texture repeats once a voxel */
  uint16_t material;
  uint16_t reserved; /* 0 */
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

/* Meshes. A face belongs to the chunk of its solid voxel. Shapes that are no cubes are drawn as
 * cubes. */

/* visibilities[i] is RUNSTONE_EMPTY, OPAQUE or TRANSPARENT for material i. Materials without an
 * entry are opaque; material 0 is always empty. */
RUNSTONE_API runstone_status runstone_visibility_create(const uint8_t* visibilities, size_t count,
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
/* Writes the quads of a pass, 8 bytes each (docs/meshing.md), by direction, then layer. */
RUNSTONE_API runstone_status runstone_mesh_quads(const runstone_mesh* mesh, uint32_t pass,
                                                 uint64_t* out, size_t capacity, size_t* count);
/* Writes the quads of one direction and layer, 0 .. 127, so that a vertex buffer can be replaced
 * in part. */
RUNSTONE_API runstone_status runstone_mesh_layer_quads(const runstone_mesh* mesh, uint32_t pass,
                                                       uint32_t direction, uint32_t layer,
                                                       uint64_t* out, size_t capacity,
                                                       size_t* count);
/* Writes four vertices for each quad of a pass, counter-clockwise seen from outside. */
RUNSTONE_API runstone_status runstone_mesh_vertices(const runstone_mesh* mesh, uint32_t pass,
                                                    runstone_vertex* out, size_t capacity,
                                                    size_t* count);
/* Writes six indices for each quad of a pass: two triangles of its four vertices. */
RUNSTONE_API runstone_status runstone_mesh_indices(const runstone_mesh* mesh, uint32_t pass,
                                                   uint32_t* out, size_t capacity, size_t* count);
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

#ifdef __cplusplus
}
#endif
#endif
