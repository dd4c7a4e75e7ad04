-- The layer of settle.lua with units of 7000 tetrahedra, 351,000 in all: laid, at rest as rigid bodies, then
-- deformable under a flow for some thousand steps. It measures what a study on a cluster would take.
--
--   ./cdem run examples/armour_pile/fine.lua --ranks 2 --threads 1
--   mpirun -n 64 cdem run examples/armour_pile/fine.lua --threads 1 --set steps=20000
local cdem = require "cdem"
local set_up = require "pile"

local count = cdem.parameter{ name = "count", default = 50, range = {8, 1000} }
local columns = cdem.parameter{ name = "columns", default = math.min(5, count // 3), range = {2, math.min(30, count // 3)},
                                doc = "units in a row" }
local fineness = cdem.parameter{ name = "fineness", default = 15.3, range = {1.5, 30},
                                 doc = "height over the edge length of the tetrahedra" }
local held = cdem.parameter{ name = "held", default = 5, range = {1, 100}, doc = "how many of the lowest units are held" }
local rest = cdem.parameter{ name = "rest_time", default = 2.0, range = {1e-3, 100}, unit = "s",
                             doc = "for the rigid units to come to rest, at most" }
local velocity = cdem.parameter{ name = "velocity", default = 6.0, range = {0, 100}, unit = "m/s", doc = "of the flow" }
local steps = cdem.parameter{ name = "steps", default = 3000, range = {1, 1e9}, doc = "of the deformable pile" }

local mass = 5000
local solid = cdem.accropode{ mass = mass, density = set_up.density, width = 0.40, corner = 0 }
local height = solid.height
local coarse, unit = solid:mesh{ size = height / 3 }, solid:mesh{ size = height / fineness }
local length = (math.ceil(count / columns) * 0.55 + 2.5) * height
local laid = cdem.place{ unit = coarse, count = count, onto = set_up.slope(length, (2 * columns + 3) * height * 0.62, height),
                         columns = columns, walls = true, friction_angle = 12 }
local pile = laid:with_unit{ unit = unit }
local model = set_up.model(pile, { length = length, friction_angle = 35, walls = true, stiffness_damping = 1e-5 })
model:fix{ on = cdem.select.units{ body = "units", numbers = model:lowest_units{ body = "units", count = held } } }

model:make_rigid{ on = "units" }
local settled = model:settle{ max_time = rest, friction_angle = 15 }
model:make_deformable{ on = "units" }
model:flow{ on = "units", direction = {1.5, 0, 1}, water_density = set_up.water, velocity = velocity }
local run = model:run{ steps = steps }

local contacts = model:contacts()
cdem.report{
  { name = "tets_per_unit", value = unit.tets },
  { name = "rigid_steps", value = settled.steps },
  { name = "rigid_wall_time_s", value = settled.wall_time },
  { name = "rigid_kinetic_ratio", value = settled.kinetic_ratio },
  { name = "time_step_s", value = run.time_step },
  { name = "steps", value = run.steps },
  { name = "steps_per_second", value = run.steps / run.wall_time },
  { name = "contacts", value = contacts.acting },
  { name = "max_penetration_over_tet_height", value = contacts.deepest_over_tet_height },
  { name = "energy_balance_error", value = model:energy().balance_error },
}
