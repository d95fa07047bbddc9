/* runstone_runs.h: reads the raw bytes of a chunk in place. It needs no library: C99 or C++, any
 * byte order, no allocation. docs/protocol.md specifies the bytes:
 *   u8 1 | u8 version 1 | u8 axis order | u8 0 | u8 x, y, z sides | u8 0 | u32 run count | runs
 * A volume of up to 65,535 voxels has runs {u16 end, u16 material}; a larger one has all u32
 * ends, then all u16 materials. Numbers are little-endian. Run i covers the voxels from the end
 * of the run before it up to its own end, of the chunk flattened in its axis order.
 *
 *   runstone_runs runs;
 *   if (runstone_runs_open(&runs, bytes, count) == RUNSTONE_RUNS_OK)
 *     printf("%u\n", (unsigned)runstone_runs_at(&runs, x, y, z));
 *
 * A runstone_runs points into the bytes, which the caller keeps. It is never changed after it was
 * opened, so any number of threads may read it. */
#ifndef RUNSTONE_RUNS_H
#define RUNSTONE_RUNS_H

#include <stddef.h>
#include <stdint.h>

typedef struct runstone_runs {
  const uint8_t* runs; /* the bytes behind the head */
  uint32_t sides[3];   /* x, y, z: 8 .. 128 voxels */
  uint32_t axes[3];    /* the axes of the flattened chunk, fastest first: 0 is x, 1 is y, 2 is z */
  uint32_t volume;     /* voxels */
  uint32_t count;      /* runs */
  uint32_t is_wide;    /* 1: u32 ends */
} runstone_runs;

typedef enum runstone_runs_error {
  RUNSTONE_RUNS_OK = 0,
  RUNSTONE_RUNS_NOT_RAW = 1,    /* another encoding or version: unpack it with the library */
  RUNSTONE_RUNS_BAD_HEAD = 2,   /* a reserved byte, the axis order or a side */
  RUNSTONE_RUNS_WRONG_SIZE = 3, /* bytes are missing or left over */
  RUNSTONE_RUNS_BAD_RUNS = 4    /* ends do not ascend to the volume, or neighbours are equal */
} runstone_runs_error;

static inline uint32_t runstone_runs_number(const uint8_t* bytes, uint32_t size) {
  uint32_t number = 0, i;
  for (i = 0; i < size; ++i) number |= (uint32_t)bytes[i] << (8 * i);
  return number;
}

/* Returns the end of run i: the index of the first voxel after it. Requires i < count. */
static inline uint32_t runstone_runs_end(const runstone_runs* runs, uint32_t i) {
  return runstone_runs_number(runs->runs + (size_t)4 * i, runs->is_wide ? 4 : 2);
}

/* Returns the material of run i. Requires i < count. */
static inline uint16_t runstone_runs_material(const runstone_runs* runs, uint32_t i) {
  const size_t at = runs->is_wide ? (size_t)4 * runs->count + (size_t)2 * i : (size_t)4 * i + 2;
  return (uint16_t)runstone_runs_number(runs->runs + at, 2);
}

/* Checks all bytes of a chunk and makes *out read them. *out is not changed unless the result is
 * RUNSTONE_RUNS_OK. Cost: O(runs). */
static inline runstone_runs_error runstone_runs_open(runstone_runs* out, const uint8_t* bytes,
                                                     size_t size) {
  static const uint8_t kAxes[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                      {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  runstone_runs runs;
  uint32_t i, begin = 0;
  if (bytes == NULL || size < 2) return RUNSTONE_RUNS_WRONG_SIZE;
  if (bytes[0] != 1 || bytes[1] != 1) return RUNSTONE_RUNS_NOT_RAW;
  if (size < 12) return RUNSTONE_RUNS_WRONG_SIZE; /* other encodings can be shorter */
  if (bytes[2] > 5 || bytes[3] != 0 || bytes[7] != 0) return RUNSTONE_RUNS_BAD_HEAD;
  for (i = 0; i < 3; ++i) {
    runs.sides[i] = bytes[4 + i];
    runs.axes[i] = kAxes[bytes[2]][i];
    if (runs.sides[i] < 8 || runs.sides[i] > 128) return RUNSTONE_RUNS_BAD_HEAD;
  }
  runs.volume = runs.sides[0] * runs.sides[1] * runs.sides[2];
  runs.is_wide = runs.volume > 65535;
  runs.count = runstone_runs_number(bytes + 8, 4);
  runs.runs = bytes + 12;
  if ((size - 12) / (runs.is_wide ? 6 : 4) != runs.count ||
      (size - 12) % (runs.is_wide ? 6 : 4) != 0)
    return RUNSTONE_RUNS_WRONG_SIZE;
  for (i = 0; i < runs.count; ++i) {
    const uint32_t end = runstone_runs_end(&runs, i);
    if (end <= begin || end > runs.volume) return RUNSTONE_RUNS_BAD_RUNS;
    if (i > 0 && runstone_runs_material(&runs, i) == runstone_runs_material(&runs, i - 1))
      return RUNSTONE_RUNS_BAD_RUNS;
    begin = end;
  }
  if (begin != runs.volume) return RUNSTONE_RUNS_BAD_RUNS;
  *out = runs;
  return RUNSTONE_RUNS_OK;
}

/* Returns the place of a voxel in the flattened chunk. Requires a position inside the chunk. */
static inline uint32_t runstone_runs_index(const runstone_runs* runs, uint32_t x, uint32_t y,
                                           uint32_t z) {
  uint32_t at[3];
  at[0] = x;
  at[1] = y;
  at[2] = z;
  return at[runs->axes[0]] +
         runs->sides[runs->axes[0]] *
             (at[runs->axes[1]] + runs->sides[runs->axes[1]] * at[runs->axes[2]]);
}

/* Returns the material of a voxel. Requires a position inside the chunk. Cost: O(log runs). */
static inline uint16_t runstone_runs_at(const runstone_runs* runs, uint32_t x, uint32_t y,
                                        uint32_t z) {
  const uint32_t voxel = runstone_runs_index(runs, x, y, z);
  uint32_t first = 0, last = runs->count - 1; /* the run is one of these */
  while (first < last) {
    const uint32_t middle = first + (last - first) / 2;
    if (runstone_runs_end(runs, middle) > voxel) {
      last = middle;
    } else {
      first = middle + 1;
    }
  }
  return runstone_runs_material(runs, first);
}

/* Writes the materials of all voxels to an array of `volume` elements, in the order of the
 * flattened chunk. Cost: O(volume). */
static inline void runstone_runs_to_array(const runstone_runs* runs, uint16_t* out) {
  uint32_t i, voxel = 0;
  for (i = 0; i < runs->count; ++i) {
    const uint32_t end = runstone_runs_end(runs, i);
    const uint16_t material = runstone_runs_material(runs, i);
    while (voxel < end) out[voxel++] = material;
  }
}

#endif
