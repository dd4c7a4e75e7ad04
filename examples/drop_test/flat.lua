-- The force of a flat fall on a rigid floor: a column stops from below, and until the wave comes back from its top the
-- floor carries rho c v A. Poisson's ratio is 0, so that the wave is that of one dimension.
--
--   ./cdem run examples/drop_test/flat.lua [--set velocity=2] [--set divisions=10]
local cdem = require "cdem"

local velocity = cdem.parameter{ name = "velocity", default = 0.5, range = {0.01, 20}, unit = "m/s" }
local divisions = cdem.parameter{ name = "divisions", default = 6, range = {2, 30}, doc = "of the cube's edges" }
local stiffness = cdem.parameter{ name = "contact_stiffness", default = 0.0, range = {0, 1e16}, unit = "Pa/m",
                                  doc = "0: the contact's own" }

local side = 1.0
local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0, density = 2400 }
local c = math.sqrt(concrete.youngs_modulus / concrete.density)
local cube = cdem.box_mesh{ size = {side, side, side}, divisions = {divisions, divisions, divisions} }
local floor = cdem.solid.box{ size = {2, 2, 0.2}, origin = {-0.5, -0.5, -0.2 - 1e-6} }:mesh{ size = 0.4 }
local law = cdem.coulomb{ friction_angle = 0, normal_stiffness = stiffness > 0 and stiffness or nil,
                          shear_stiffness = stiffness > 0 and stiffness or nil }
local model = cdem.model{ bodies = { { shape = floor, material = concrete, element = "rigid", name = "floor" },
                                     { shape = cube, material = concrete, name = "cube" } },
                          contacts = { { "floor", "cube", law } } }
model:fix{ on = "floor" }
model:initial_velocity{ on = "cube", velocity = {0, 0, -velocity} }
model:record_reaction{ name = "floor", on = "floor" }
model:record_momentum{ name = "cube", body = "cube" }
local contact = 2 * side / c
model:run{ duration = 2 * contact, every = 1 }
local history = model:history()
local force, times = history.floor_z or {}, history.time -- a run that is only checked has none
local peak, ended, plateau, count = 0, 0, 0, 0
for i, f in ipairs(force) do
  f = math.abs(f)
  peak = math.max(peak, f)
  if f > 0 then ended = times[i] end
  if times[i] > 0.25 * contact and times[i] < 0.75 * contact then plateau, count = plateau + f, count + 1 end
end
local x, y = {}, {}
local scale = concrete.density * c * velocity * side ^ 2
for i, f in ipairs(force) do x[i], y[i] = times[i] / contact, math.abs(f) / scale end
cdem.chart{ file = "force.png", title = "A cube that falls flat on a rigid floor", x_label = "time over 2 L / c",
            y_label = "force over rho c v A",
            series = { { name = "cdem", x = x, y = y },
                       { name = "wave in one dimension", x = {0, 0, 1, 1, 2}, y = {0, 1, 1, 0, 0} } } }
cdem.report{
  { name = "force_over_rho_c_v_a", value = count > 0 and plateau / count / scale, reference = 1, kind = "formula",
    source = "rho c v A; mean over half the contact", tolerance = 0.05 },
  { name = "peak_over_rho_c_v_a", value = peak / scale }, -- the mesh rings
  { name = "contact_time_over_2l_c", value = ended / contact, reference = 1, kind = "formula", source = "2 L / c" },
  { name = "rebound",
    value = history.cube_z and #history.cube_z > 0 and history.cube_z[#history.cube_z] / (concrete.density * side ^ 3 * velocity),
    reference = 1, kind = "formula", source = "all of the wave leaves" },
  { name = "energy_balance_error", value = model:energy().balance_error, reference = 0, kind = "formula",
    source = "energy is conserved", tolerance_absolute = 0.01 },
}
