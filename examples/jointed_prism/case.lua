-- Strength of a prism with one joint at every angle (Jaeger 1960): as two blocks of plastic rock, and as a mesh of rock that
-- cracks, beside the formula.
--
--   ./cdem run examples/jointed_prism/case.lua [--set angles=30,60] [--set size=0.03]
local cdem = require "cdem"

local angles = cdem.parameter{ name = "angles", default = {20, 40, 60, 75}, range = {5, 75},
                               unit = "deg", doc = "dips of the joint" }
local size = cdem.parameter{ name = "size", default = 0.05, range = {0.01, 0.1}, unit = "m", doc = "of tetrahedra" }

local width, height, E, nu = 0.1, 0.45, 30e9, 0.2 -- m, m, Pa, 1
local rock = { cohesion = 12e6, friction_angle = 40, tensile_strength = 8e6 }
local weak = { cohesion = 3e6, friction_angle = 30, tensile_strength = 1e6 }
local lateral = 5e6 -- Pa
local stone = cdem.elastic{ youngs_modulus = E, poissons_ratio = nu, density = 2600 }

-- Largest axial pressure: on the joint at the dip b, but never more than the rock bears.
local function formula(b)
  local function tan(degrees) return math.tan(math.rad(degrees)) end
  local N = tan(45 + rock.friction_angle / 2)
  local intact, grip = lateral * N ^ 2 + 2 * rock.cohesion * N, 1 - tan(weak.friction_angle) / tan(b)
  if grip <= 0 then return intact end
  return math.min(intact, lateral + 2 * (weak.cohesion + lateral * tan(weak.friction_angle)) / grip / math.sin(math.rad(2 * b)))
end

local function halves(b)
  return cdem.cut_by_plane{ shape = cdem.box{ size = {width, width, height} }, name = "joint",
                            point = {width / 2, width / 2, height / 2},
                            normal = {math.sin(math.rad(b)), 0, math.cos(math.rad(b))} }
end
local bodies = {
  blocks = function(b)
    return { name = "prism", shape = halves(b), material = stone, zone_size = size, plasticity = cdem.plastic(rock),
             joint = cdem.mohr_coulomb(weak) }
  end,
  mesh = function(b)
    return { name = "prism", shape = halves(b):solid():mesh{ size = size }, material = stone, joint = cdem.mohr_coulomb(rock),
             region_joints = { {1, 2, cdem.mohr_coulomb(weak)} } }
  end }

-- Presses the prism between smooth platens in relaxed increments until the pressure has fallen; returns its peak, Pa.
local function strength(body, expected)
  local rubbing = cdem.coulomb{ friction_angle = weak.friction_angle }
  local model, peak = cdem.model{ bodies = {body}, contacts = { default = rubbing } }, 0
  model:fix{ on = "z-", axes = "z" }
  model:fix{ on = cdem.select.box{ min = {0, 0, 0}, max = {0, 0, 0} }, axes = "xy" }
  model:fix{ on = cdem.select.box{ min = {width, 0, 0}, max = {width, 0, 0} }, axes = "y" }
  for _, side in ipairs{ "x-", "x+", "y-", "y+" } do model:traction{ on = side, pressure = lateral } end
  local parts = { 0.3, 0.6, 0.8, 0.9 } -- of the elastic shortening at the strength
  for part = 0.94, 1.16, 0.02 do parts[#parts + 1] = part end
  for _, part in ipairs(parts) do
    model:fix{ on = "z+", axes = "z", displacement = {0, 0, -part * (expected - 2 * nu * lateral) / E * height} }
    model:relax{ residual = 2e-4, max_steps = 10000 }
    local pressure = -model:reaction("z+")[3] / width ^ 2
    peak = math.max(peak, pressure)
    if pressure < 0.97 * peak then break end
  end
  return peak, model
end

local figures, found = {}, { blocks = {}, mesh = {} }
for kind, body in pairs(bodies) do
  local worst = 0
  for i, b in ipairs(angles) do
    local peak, model = strength(body(b), formula(b))
    found[kind][i] = peak
    worst = math.max(worst, math.abs(peak / formula(b) - 1))
    figures[#figures + 1] = { name = string.format("%s_%g_Pa", kind, b), value = peak, reference = formula(b), unit = "Pa",
                              kind = "formula", source = "Jaeger 1960", tolerance = 0.05 }
    if kind == "mesh" and (b == 60 or #angles == 1) then
      model:picture{ file = "slipped.png", colour = "displacement.x", deformation = 100, up = "z", size = {900, 0},
                     title = "Slip along the joint" }
    end
  end
  figures[#figures + 1] = { name = kind .. "_worst_error", value = worst, reference = 0, kind = "formula",
                            source = "Jaeger 1960", tolerance_absolute = 0.05 }
end
local all, curve = cdem.linspace(5, 85, 161), {}
for i, b in ipairs(all) do curve[i] = formula(b) end
cdem.chart{ file = "strength.png", title = "Strength of a prism with one joint", x_label = "dip of the joint (°)",
            y_label = "axial pressure (Pa)", series = { { name = "Jaeger", x = all, y = curve },
            { name = "blocks", x = angles, y = found.blocks, style = "points" },
            { name = "mesh", x = angles, y = found.mesh, style = "points" } } }
figures[#figures + 1] = { name = "wall_time_s", value = cdem.elapsed(), unit = "s" }
cdem.report(figures)
