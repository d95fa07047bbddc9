/* Both headers compile as C99 with all warnings, and the sizes of structs, which programs are
 * compiled with, stay as they are. A negative size of an array is an error. */
#include <runstone.h>
#include <runstone_runs.h>

#define STAYS(name, type, size) typedef char name[sizeof(type) == (size) ? 1 : -1]
STAYS(runstone_size_pos, runstone_pos, 12);
STAYS(runstone_size_box, runstone_box, 24);
STAYS(runstone_size_vec, runstone_vec, 24);
STAYS(runstone_size_body, runstone_body, 48);
STAYS(runstone_size_local_box, runstone_local_box, 6);
STAYS(runstone_size_chunk_info, runstone_chunk_info, 32);
STAYS(runstone_size_brush, runstone_brush, 12);
STAYS(runstone_size_changes, runstone_changes, 64);
STAYS(runstone_size_quad_fields, runstone_quad_fields, 36);
STAYS(runstone_size_vertex, runstone_vertex, 36);
STAYS(runstone_size_sweep, runstone_sweep, 32);
STAYS(runstone_size_slide, runstone_slide, 32);
STAYS(runstone_size_ray, runstone_ray, 40);
STAYS(runstone_size_client_options, runstone_client_options, 112);
STAYS(runstone_size_event, runstone_event, 56);
STAYS(runstone_size_place, runstone_place, 40);
STAYS(runstone_size_world_info, runstone_world_info, 240);
STAYS(runstone_size_material_info, runstone_material_info, 84);
STAYS(runstone_size_player, runstone_player, 120);

int runstone_headers_compile(void);
int runstone_headers_compile(void) {
  runstone_runs runs;
  return (int)runstone_runs_open(&runs, NULL, 0) + (int)runstone_abi();
}
