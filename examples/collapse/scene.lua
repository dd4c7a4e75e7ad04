-- The bodies of the collapse, how they are drawn, and what is measured of them.
local cdem = require "cdem"

local count = cdem.parameter{ name = "blocks", default = 30, range = {1, 5000}, doc = "of the heap" }
local element = cdem.parameter{ name = "element", default = "rigid", choices = {"finite_volume", "rigid"} }
local stiffness = cdem.parameter{ name = "contact_stiffness", default = 2e10, range = {1e8, 1e13}, unit = "Pa/m",
                                  doc = "pressure over depth of a contact" }
local friction = cdem.parameter{ name = "friction_angle", default = 30.0, range = {1, 80}, unit = "degrees" }

local d, length, drop = 0.25, 0.8, 0.8 -- m; d: cube root of a block's volume
-- More blocks make the heap wider and higher, not longer: the pusher moves all of it over the edge.
local scale = math.max(1, math.sqrt(count / 30))
local width = 1.2 * scale
local scene = { held = {"ledge", "floor", "unit_1", "unit_2"} }

function scene.model()
  local height = count * d ^ 3 / (length * width)
  local stone = cdem.elastic{ youngs_modulus = 1e9, poissons_ratio = 0.2, density = 2500 }
  local rough = cdem.coulomb{ friction_angle = friction, normal_stiffness = stiffness, shear_stiffness = stiffness }
  local solid = cdem.accropode{ height = 0.7, corner = 0 }
  local function loose(name, shape)
    return { name = name, shape = shape, material = stone, joint = rough, element = element }
  end
  local function stiff(name, shape) return { name = name, shape = shape, material = stone, element = "rigid" } end
  local function unit(x, y, angle)
    local turned = solid:rotate{ axis = {0, 0, 1}, angle = angle }
    return turned:translate{ shift = {x, y, -drop - turned:box().min[3]} }:mesh{ size = 0.25 }
  end
  return cdem.model{ bodies = {
    loose("heap", cdem.voronoi{ size = {length, width, height}, count = count, origin = {-length - 0.2, -width / 2, 0} }),
    loose("bricks", cdem.bricks{ size = {0.2, width, 0.4}, brick = {0.2, 0.4, 0.2}, origin = {-0.2, -width / 2, 0} }),
    stiff("ledge", cdem.box{ size = {1.6, width + 0.4, 0.3}, origin = {-1.6, -width / 2 - 0.2, -0.3} }),
    stiff("floor", cdem.box{ size = {12 * scale, 14 * scale, 0.2}, origin = {-4 * scale, -7 * scale, -drop - 0.2} }),
    stiff("pusher", cdem.box{ size = {0.2, width + 0.2, 0.8 * height}, origin = {-length - 0.4, -width / 2 - 0.1, 0.02} }),
    stiff("unit_1", unit(0.5, -0.4, 20)),
    stiff("unit_2", unit(0.8, 0.4, 75)),
  }, contacts = { default = rough } }
end

function scene.draw(model, name)
  local away = 0.55 + 0.45 * scale -- of the camera
  model:picture{ file = name, colour = "velocity.magnitude", range = {0, 5}, deformation = 1, broken_bonds = false,
                 axes = false, title = string.format("A heap pushed off a ledge, %.2f s", model.time),
                 plain = {"ledge", "floor", "pusher", "unit_1", "unit_2"},
                 camera = { position = {5 * away, -4.5 * away, 2 * away}, focal_point = {0.4 * away - 0.2, 0, -0.4},
                            up = {0, 0, 1}, view_angle = 30 } }
  return name
end

-- What lies lower than it would if it had gone through the floor: blocks whose centroid is below the floor's top.
function scene.report(model, run)
  local through, moved, volume = 0, 0, 0
  for _, block in ipairs(model:blocks()) do
    if block.body == "heap" or block.body == "bricks" then
      local z = block.centroid[3] + block.displacement[3]
      volume = volume + block.volume
      if z < -drop then through = through + 1 end
      if z < 0 then moved = moved + 1 end
    end
  end
  local figures = {
    { name = "blocks_below_the_floor", value = through, reference = 0, kind = "formula", source = "none passes through",
      tolerance_absolute = 0.5 },
    { name = "blocks_off_the_ledge", value = moved },
    { name = "overlap_over_volume", value = model:overlap().volume / volume, reference = 0, kind = "formula",
      source = "none passes through", tolerance_absolute = 1e-4 },
    { name = "deepest_over_block_size", value = model:contacts().deepest / d, source = "in the impact" },
    { name = "energy_balance_error", value = model:energy().balance_error, reference = 0, kind = "formula",
      source = "energy is conserved", tolerance_absolute = 1e-3 },
    { name = "energy_balance_error_undamped", value = run.undamped },
    { name = "largest_velocity_m_per_s", value = model:max("velocity.magnitude", "heap"), unit = "m/s" },
    { name = "steps", value = model.steps },
    { name = "wall_time_s", value = cdem.elapsed(), unit = "s" },
  }
  if run.at_rest ~= nil then
    figures[#figures + 1] = { name = "at_rest", value = run.at_rest and 1 or 0, reference = 1, kind = "formula",
                              source = "kinetic energy below 1e-6 of its peak while it settles" }
  end
  cdem.report(figures)
end

return scene
