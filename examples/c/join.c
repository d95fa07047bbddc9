/* Joins a server, meshes the chunks around the player, sets a voxel there and leaves. */
#include <runstone.h>
#include <stdio.h>
#include <stdlib.h>

/* Ends the program with the words of a refusal. */
static void check(runstone_status status) {
  if (status == RUNSTONE_OK) return;
  fprintf(stderr, "%s: %s\n", runstone_status_name(status), runstone_last_error());
  exit(1);
}

int main(int argc, char** argv) {
  const runstone_brush stone = {sizeof stone, RUNSTONE_MASK_EVERYTHING, 0, 1};
  runstone_client_options options;
  runstone_client* client = NULL;
  runstone_edits* edits = NULL;
  runstone_mesh* mesh = NULL;
  runstone_event events[64];
  runstone_place place;
  runstone_pos voxel;
  uint32_t state = RUNSTONE_CLIENT_CONNECTING, is_complete = 0, is_sent = 0, is_done = 0;
  size_t count = 0, i, quads, all_quads = 0;
  char text[256];

  options.struct_size = sizeof options;
  check(runstone_client_default_options(&options));
  options.server = argc > 1 ? argv[1] : "localhost";
  check(runstone_client_connect(&options, &client));
  check(runstone_edits_create(&edits));
  check(runstone_mesh_create(&mesh));
  while (!is_done && state != RUNSTONE_CLIENT_ENDED) {
    check(runstone_client_wait(client, 10)); /* a game draws a frame instead */
    check(runstone_client_step(client, NULL));
    check(runstone_client_drain(client, 16, events, sizeof events[0], 64, &count));
    for (i = 0; i < count; ++i) {
      if (events[i].kind == RUNSTONE_EVENT_CHUNK_CHANGED) {
        check(runstone_client_mesh(client, i, mesh)); /* replaces the mesh of events[i].at */
        check(runstone_mesh_quads(mesh, RUNSTONE_PASS_OPAQUE, NULL, 0, &quads));
        all_quads += quads;
      } else if (events[i].kind == RUNSTONE_EVENT_EDIT_CONFIRMED) {
        printf("%u quads; the edit is record %u\n", (unsigned)all_quads,
               (unsigned)events[i].sequence);
        is_done = 1;
      } else if (runstone_client_event_text(client, i, text, sizeof text, &quads) == RUNSTONE_OK &&
                 text[0] != '\0') {
        puts(text); /* the chat, or why a connection or an edit failed */
      }
    }
    check(runstone_client_state(client, &state, &is_complete));
    if (!is_complete || is_sent) continue;
    check(runstone_client_place(client, &place));
    voxel.x = (int32_t)place.at.x, voxel.y = (int32_t)place.at.y, voxel.z = (int32_t)place.at.z;
    check(runstone_edits_add_voxel(edits, voxel, &stone));
    check(runstone_client_submit(client, edits, 0, 0, NULL));
    is_sent = 1;
  }
  check(runstone_client_free(client)); /* the other handles end with the program */
  return is_done ? 0 : 1;
}
