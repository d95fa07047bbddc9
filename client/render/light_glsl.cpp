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
  colour("ambient_side", light.ambient_side);
  colour("ambient_down", light.ambient_down);
  colour("dark", light.dark);
  const auto number = [&program](const char* name, float value) {
    glUniform1f(glGetUniformLocation(program.get(), name), value);
  };
  number("lamps", light.lamps);
  number("exposure", light.exposure);
  number("night", light.night);
  number("eye_height", light.eye_height);
  glUniform4f(glGetUniformLocation(program.get(), "fog"), light.fog_start, light.fog_fade,
              light.fog_end, light.haze);
}

}  // namespace runstone
