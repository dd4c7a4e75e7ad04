-- A rigid unit is let go at rest, tilted back so that its centre of mass is a height above that of the impact, and overturns on a
-- rigid floor: the velocity with which case.lua begins.
--
--   ./cdem run examples/drop_test/overturn.lua [--set shape=dolos] [--set share=0.7]
local cdem = require "cdem"
local place = require "place"

local shape = cdem.parameter{ name = "shape", default = "cube", choices = {"cube", "cubipod", "dolos", "accropode"} }
local heading = cdem.parameter{ name = "heading", default = 0.0, range = {-360, 360}, unit = "deg" }
local mass = cdem.parameter{ name = "mass", default = 16000.0, range = {1, 1e6}, unit = "kg" }
local friction = cdem.parameter{ name = "friction_angle", default = 35.0, range = {0, 89}, unit = "deg",
                                 doc = "of unit and floor" }
local fineness = cdem.parameter{ name = "fineness", default = 4.0, range = {2, 30}, doc = "Dn over edge of the tets" }
local share = cdem.parameter{ name = "share", default = 0.3, range = {0.05, 0.9}, doc = "of the height from balance" }

local g, density = 9.81, 2400
local size = (mass / density) ^ (1 / 3)
local concrete = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = density }
local make = { cube = cdem.cube, cubipod = cdem.cubipod, dolos = cdem.dolos, accropode = cdem.accropode }
local edge_length = size / fineness
local as_built = make[shape]{ mass = mass, density = density }:rotate{ axis = {0, 0, 1}, angle = heading }
local over = place.overturning(as_built, size)
local height = share * place.balance_height(over)
local unit = over.at(over.angle - place.tilt(over, height))
local mesh = unit:translate{ shift = {0, 0, -unit:mesh{ size = edge_length }:box().min[3]} }:mesh{ size = edge_length }
local floor = cdem.solid.box{ size = {8 * size, 8 * size, size}, origin = {-4 * size, -4 * size, -size} }:mesh{ size = 2 * size }
local model = cdem.model{ bodies = { { shape = floor, material = concrete, element = "rigid", name = "floor" },
                                     { shape = mesh, material = concrete, element = "rigid", name = "unit" } },
                          contacts = { { "floor", "unit", cdem.coulomb{ friction_angle = friction } } } }
model:fix{ on = "floor" }
model:gravity{ vector = {0, 0, -g} }

local function now()
  for _, piece in ipairs(model:fragments()) do if piece.body == "unit" then return piece end end
end
local start = now().centre[3]
local way = 0.98 * height -- just before the touch
model:run{ duration = 10 * math.sqrt(size / g), every = 5, stop = function() return now().centre[3] <= start - way end }
local v, expected = now().velocity, over.arm * math.sqrt(2 * over.mass * g * way / over.inertia)
local speed = math.sqrt(v[1] ^ 2 + v[2] ^ 2 + v[3] ^ 2)
cdem.report{
  { name = "height_m", value = height, unit = "m" },
  { name = "impact_velocity_m_per_s", value = speed, unit = "m/s", reference = expected, kind = "formula", tolerance = 0.02,
    source = "m g h is the energy of the rotation about the lower edge" },
  { name = "velocity_over_formula", value = speed / expected, reference = 1, kind = "formula", source = "the same",
    tolerance = 0.02 },
  { name = "time_s", value = model.time, unit = "s" },
  { name = "wall_time_s", value = cdem.elapsed(), unit = "s" },
}
