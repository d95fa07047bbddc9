/* A hill of eight steps becomes runs, and the runs become the quads to draw. */
#include <runstone.h>
#include <stdio.h>
#include <stdlib.h>

/* Ends the program with the words of a refusal. */
static void check(runstone_status status) {
  if (status == RUNSTONE_OK) return;
  fprintf(stderr, "%s: %s\n", runstone_status_name(status), runstone_last_error());
  exit(1);
}

int main(void) {
  const runstone_pos origin = {0, 0, 0};
  const runstone_brush stone = {sizeof stone, RUNSTONE_MASK_EVERYTHING, 0, 1};
  runstone_changes changes = {sizeof changes, 0, 0, {{0}}};
  runstone_chunk* chunk = NULL;
  runstone_edits* edits = NULL;
  runstone_visibility* visibility = NULL;
  runstone_mesh* mesh = NULL;
  size_t count = 0, i;
  uint64_t* quads;
  int32_t s;

  check(runstone_chunk_create_filled(32, 32, 32, 0, &chunk)); /* 0 is empty */
  check(runstone_edits_create(&edits));
  for (s = 0; s < 16; s += 2) {
    const runstone_box step = {{s, s, s}, {32 - s, s + 2, 32 - s}};
    check(runstone_edits_add_box(edits, step, &stone));
  }
  check(runstone_chunk_apply(chunk, origin, edits, &changes));

  check(runstone_visibility_create(NULL, 0, &visibility)); /* all materials are opaque */
  check(runstone_mesh_create(&mesh));
  check(runstone_mesh_chunk(mesh, chunk, NULL, NULL, visibility));         /* without neighbours */
  check(runstone_mesh_quads(mesh, RUNSTONE_PASS_OPAQUE, NULL, 0, &count)); /* asks for the size */
  quads = malloc(count * sizeof *quads);
  if (quads == NULL) return 1;
  check(runstone_mesh_quads(mesh, RUNSTONE_PASS_OPAQUE, quads, count, &count));
  printf("%u voxels of stone, %u quads\n", (unsigned)changes.voxels, (unsigned)count);
  for (i = 0; i < count && i < 3; ++i) {
    runstone_quad_fields quad = {sizeof quad, 0, 0, 0, 0, 0, 0, 0, 0};
    check(runstone_quad_unpack(quads[i], &quad));
    printf("%u x %u faces at %u %u %u\n", (unsigned)quad.width, (unsigned)quad.height,
           (unsigned)quad.x, (unsigned)quad.y, (unsigned)quad.z);
  }

  free(quads);
  check(runstone_mesh_free(mesh));
  check(runstone_visibility_free(visibility));
  check(runstone_edits_free(edits));
  check(runstone_chunk_free(chunk));
  return 0;
}
