#include "client/render/light_glsl.hpp"

#include <glm/gtc/type_ptr.hpp>

namespace runstone {

void set_light(const GlProgram& program, const DayLight& light) {
  const auto colour = [&program](const char* name, const glm::vec3& value) {
    glUniform3fv(glGetUniformLocation(program.get(), name), 1, glm::value_ptr(value));
  };
  colour("sun_direction", light.sun_direction);
  colour("sun_colour", light.sun_colour);
  colour("zenith", light.zenith);
  colour("horizon", light.horizon);
  colour("nadir", light.nadir);
  colour("glow", light.glow);
  colour("ambient_up", light.ambient_up);
  colour("ambient_down", light.ambient_down);
  colour("dark", light.dark);
  glUniform1f(glGetUniformLocation(program.get(), "lamps"), light.lamps);
  glUniform1f(glGetUniformLocation(program.get(), "exposure"), light.exposure);
  glUniform2f(glGetUniformLocation(program.get(), "fog_range"), light.fog_start, light.fog_end);
}

}  // namespace runstone
