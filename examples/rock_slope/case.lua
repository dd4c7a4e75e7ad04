-- A rock slope on a fault that dips out of the face: stress in place, an excavation, the factor of safety by strength
-- reduction, and where the slide comes to rest. Plane sliding has F = tan(phi) / tan(dip).
--
--   ./cdem run examples/rock_slope/case.lua [--set spacing=2] [--set friction_angle=38] [--set steep=125]
local cdem = require "cdem"
local ground = require "ground"

local spacing = cdem.parameter{ name = "spacing", default = 4.0, range = {1, 10}, unit = "m", doc = "of all joint sets" }
local phi = cdem.parameter{ name = "friction_angle", default = 40.0, range = {5, 70}, unit = "degrees", doc = "of the joints" }
local steep = cdem.parameter{ name = "steep", default = 90.0, range = {60, 130}, unit = "degrees",
                              doc = "dip of the steep set; above 90 it dips into the slope" }
local runout = cdem.parameter{ name = "runout", default = 3, range = {0, 60}, unit = "s", doc = "of the slide; 0: none" }
local tolerance = cdem.parameter{ name = "tolerance", default = 0.02, range = {0.001, 0.5}, doc = "of the factor of safety" }
local dip = cdem.parameter{ name = "dip", default = 35.0, range = {34, 60}, unit = "degrees", doc = "of fault and bedding" }
local seed = cdem.parameter{ name = "seed", default = 7, range = {1, 1000}, doc = "where the scattered joints lie" }

local shape = ground.shape(dip, {
  { name = "bedding", dip = dip, dip_direction = 90, spacing = spacing },
  { name = "steep", dip = math.min(steep, 180 - steep), dip_direction = steep > 90 and 270 or 90, spacing = spacing,
    spacing_scatter = 0.2 },
  { name = "side", dip = 90, dip_direction = 0, spacing = spacing } }, seed, spacing / 20)
local rock = cdem.elastic{ youngs_modulus = 5e9, poissons_ratio = 0.25, density = 2600 }
local joint = cdem.coulomb{ friction_angle = phi }
local model = cdem.model{ bodies = { { name = "ground", shape = shape, material = rock, joint = joint } } }
model:fix{ on = {"x-", "x+"}, axes = "x" }
model:fix{ on = {"y-", "y+"}, axes = "y" }
model:fix{ on = "z-" }
model:gravity{ vector = {0, 0, -9.81} }

-- Before the excavation: weight, and half of it sideways. Then 20 m are dug.
model:initial_stress{ gradient = rock.density * 9.81, k0 = 0.5 }
model:relax{ residual = 1e-4 }
model:reset_displacement()
model:remove{ on = ground.dug }
cdem.log("after the excavation the slope is " .. model:relax{ residual = 1e-4 }.verdict)

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
  slide:picture{ file = "runout.png", up = "z", colour = "displacement.magnitude", deformation = 1, broken_bonds = false,
                 title = string.format("%g s later", runout) }
  figures[#figures + 1] = { name = "runout_mean_m", unit = "m", value = slide:mean("displacement.x", ground.slides) }
end
figures[#figures + 1] = { name = "wall_time_s", value = cdem.elapsed(), unit = "s" }
cdem.report(figures)
