-- The prism and the strength that Jaeger (1960) gives it, for the scripts of this example.
local jaeger = {}

jaeger.width, jaeger.height, jaeger.lateral = 0.1, 0.45, 5e6 -- m, m, Pa
jaeger.rock = { cohesion = 12e6, friction_angle = 40, tensile_strength = 8e6 }
jaeger.weak = { cohesion = 3e6, friction_angle = 30, tensile_strength = 1e6 }

-- Largest axial pressure, Pa: on a joint that dips at b degrees, but never more than the rock bears.
function jaeger.strength(b)
  local function tan(degrees) return math.tan(math.rad(degrees)) end
  local p3, rock, weak = jaeger.lateral, jaeger.rock, jaeger.weak
  local N = tan(45 + rock.friction_angle / 2)
  local intact, grip = p3 * N ^ 2 + 2 * rock.cohesion * N, 1 - tan(weak.friction_angle) / tan(b)
  if grip <= 0 then return intact end
  return math.min(intact, p3 + 2 * (weak.cohesion + p3 * tan(weak.friction_angle)) / grip / math.sin(math.rad(2 * b)))
end

return jaeger
