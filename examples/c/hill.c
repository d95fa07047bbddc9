/* A hill of runs is meshed, then a ball is dug out of it and the layers that changed are meshed again. */
#include <runstone.h>
#include <stdio.h>
#include <stdlib.h>

/* Ends the program with the words of a refusal. */
static void check(runstone_status status) {
  if (status == RUNSTONE_OK) return;
  fprintf(stderr, "%s: %s\n", runstone_status_name(status), runstone_last_error());
  exit(1);
}

static size_t print_quads(const char *what, const runstone_mesh *mesh) {
  size_t count = 0;
  uint64_t *quads;
  runstone_quad_fields first = {sizeof first, 0, 0, 0, 0, 0, 0, 0};
  check(runstone_mesh_quads(mesh, RUNSTONE_PASS_OPAQUE, NULL, 0, &count)); /* the size is asked first */
  quads = malloc(count * sizeof *quads);
  if (quads == NULL) exit(1);
  check(runstone_mesh_quads(mesh, RUNSTONE_PASS_OPAQUE, quads, count, &count));
  check(runstone_quad_unpack(quads[0], &first));
  printf("%s: %u quads; the first is %u x %u faces of material %u\n", what, (unsigned)count,
         (unsigned)first.width, (unsigned)first.height, (unsigned)first.material);
  free(quads);
  return count;
}

int main(void) {
  const runstone_pos origin = {0, 0, 0}, top = {16, 15, 16};
  const runstone_brush stone = {sizeof stone, RUNSTONE_MASK_EVERYTHING, 0, 1};
  const runstone_brush remove = {sizeof remove, RUNSTONE_MASK_ONLY_SOLID, 0, 0};
  runstone_changes changes = {sizeof changes, 0, 0, {{0}}};
  runstone_chunk *chunk = NULL;
  runstone_edits *edits = NULL;
  runstone_visibility *visibility = NULL;
  runstone_mesh *mesh = NULL;
  uint32_t is_whole = 0;
  int32_t step;

  check(runstone_chunk_create_filled(32, 32, 32, 0, &chunk));
  check(runstone_edits_create(&edits));
  for (step = 0; step < 8; ++step) { /* a hill of eight steps */
    const runstone_box box = {{2 * step, 2 * step, 2 * step}, {32 - 2 * step, 2 * step + 2, 32 - 2 * step}};
    check(runstone_edits_add_box(edits, box, &stone));
  }
  check(runstone_chunk_apply(chunk, origin, edits, &changes));
  printf("%u voxels of stone\n", (unsigned)changes.voxels);

  check(runstone_visibility_create(NULL, 0, &visibility)); /* every material is opaque */
  check(runstone_mesh_create(&mesh));
  check(runstone_mesh_chunk(mesh, chunk, NULL, NULL, visibility));
  print_quads("hill", mesh);

  check(runstone_edits_clear(edits));
  check(runstone_edits_add_sphere(edits, top, 2, &remove));
  check(runstone_chunk_apply(chunk, origin, edits, &changes));
  check(runstone_mesh_update(mesh, chunk, NULL, NULL, visibility, &is_whole));
  printf("%u voxels removed\n", (unsigned)changes.voxels);
  print_quads("with a pit", mesh);

  check(runstone_mesh_free(mesh));
  check(runstone_visibility_free(visibility));
  check(runstone_edits_free(edits));
  check(runstone_chunk_free(chunk));
  return 0;
}
