-- A rock slope on a fault that dips out of the face: stress in place, an excavation, the factor of safety by strength
-- reduction, and where the slide comes to rest. Plane sliding has F = tan(phi) / tan(dip).
--
--   ./cdem run examples/rock_slope/case.lua [--set spacing=2] [--set friction_angle=38]
local cdem = require "cdem"

local spacing = cdem.parameter{ name = "spacing", default = 4.0, range = {1, 10}, unit = "m", doc = "of all joint sets" }
local phi = cdem.parameter{ name = "friction_angle", default = 40.0, range = {5, 70}, unit = "degrees", doc = "of the joints" }
local runout = cdem.parameter{ name = "runout", default = 3, range = {0, 60}, unit = "s", doc = "of the slide; 0: none" }
local tolerance = cdem.parameter{ name = "tolerance", default = 0.02, range = {0.001, 0.5}, doc = "of the factor of safety" }
local dip = cdem.parameter{ name = "dip", default = 35.0, range = {34, 60}, unit = "degrees", doc = "of fault and bedding" }
local seed = cdem.parameter{ name = "seed", default = 7, range = {1, 1000}, doc = "7 leaves no slivers in the face" }
local face, g = 65, 9.81 -- degrees, m/s2

-- Ground of 60 x 8 x 32 m with a fault that dips out of the slope through (39, 14). Below the fault it is massive, above it
-- jointed. The excavation's outline is glued: it is no joint.
local tangent, run = math.tan(math.rad(face)), 1 / math.tan(math.rad(dip))
local function prism(points)
  local corners = {}
  for _, y in ipairs{ 0, 8 } do
    for _, p in ipairs(points) do corners[#corners + 1] = { p[1], y, p[2] } end
  end
  local shape = cdem.convex_hull{ points = corners }
  shape = cdem.cut_by_plane{ shape = shape, point = {40, 0, 12}, normal = {tangent, 0, 1}, name = "face", glued = true }
  return cdem.cut_by_plane{ shape = shape, point = {40, 0, 12}, normal = {0, 0, 1}, name = "floor", glued = true }
end
local foot, head = { 39 + 14 * run, 0 }, { 39 - 18 * run, 32 } -- ends of the fault
local massive, jointed = prism{ {0, 0}, foot, head, {0, 32} }, prism{ foot, {60, 0}, {60, 32}, head }
jointed = cdem.cut_by_joints{ shape = jointed, seed = seed, sets = {
  { name = "bedding", dip = dip, dip_direction = 90, spacing = spacing },
  { name = "cross", dip = 70, dip_direction = 270, spacing = spacing, spacing_scatter = 0.2 },
  { name = "side", dip = 90, dip_direction = 0, spacing = spacing } } }

local rock = cdem.elastic{ youngs_modulus = 5e9, poissons_ratio = 0.25, density = 2600 }
local joint = cdem.coulomb{ friction_angle = phi }
local model = cdem.model{ bodies = { { name = "ground", shape = cdem.merge{ shapes = {massive, jointed} },
                                       material = rock, joint = joint } } }
model:fix{ on = {"x-", "x+"}, axes = "x" }
model:fix{ on = {"y-", "y+"}, axes = "y" }
model:fix{ on = "z-" }
model:gravity{ vector = {0, 0, -g} }

-- Before the excavation: weight, and half of it sideways.
model:initial_stress{ gradient = rock.density * g, k0 = 0.5 }
model:relax{ residual = 1e-4 }
model:reset_displacement()

-- The excavation, 20 m deep. What lies in front of the face and above the floor goes.
model:remove{ on = cdem.select.where(function(x, _, z) return z > 12 and z - 12 > -tangent * (x - 40) end) }
local excavated = model:relax{ residual = 1e-4 }
cdem.log("after the excavation the slope is " .. excavated.verdict)

local function draw(m, name, title)
  m:picture{ file = name, up = "z", colour = "displacement.magnitude", deformation = 1, broken_bonds = false, title = title }
end
local safety = cdem.factor_of_safety{ model = model, reduce = {"joints"}, lower = 0.8, upper = 2, tolerance = tolerance,
                                      residual = 1e-4, picture = "mechanism.png" }
safety.failing:picture{ file = "slip.png", up = "z", view = "iso", joints = true, colour = "slip" }
local figures = { { name = "factor_of_safety", value = safety.factor, kind = "formula", tolerance = 0.03,
                    reference = math.tan(math.rad(phi)) / math.tan(math.rad(dip)), source = "tan(phi) / tan(dip)" } }

-- The slide runs out: once it moves, its joints lose a third of what they have left.
if runout > 0 then
  local slide = safety.failing
  slide:reduce_strength{ factor = 1.5, reduce = {"joints"} }
  slide:run{ duration = runout }
  draw(slide, "runout.png", string.format("%g s later", runout))
  local above = cdem.select.where(function(x, _, z) return z > 12 and z - 14 > (39 - x) / run end)
  figures[#figures + 1] = { name = "runout_mean_m", value = slide:mean("displacement.x", above), unit = "m" }
end
figures[#figures + 1] = { name = "wall_time_s", value = cdem.elapsed(), unit = "s" }
cdem.report(figures)
