-- Feng 2014, section 4: fifty armour units come to rest on a slope of 1:1.5, the lowest five held. The settled pile is
-- saved and can be loaded many times, in any size.
--
--   ./cdem run examples/armour_pile/settle.lua [--set start=drop] [--set mass=5000] [--set count=50]
local cdem = require "cdem"
local set_up = require "pile"

local start = cdem.parameter{ name = "start", default = "place", choices = {"drop", "place"},
                              doc = "drop: three layers fall in random attitudes; place: one armour layer is laid" }
local mass = cdem.parameter{ name = "mass", default = 5000.0, range = {1, 1e6}, unit = "kg" }
local count = cdem.parameter{ name = "count", default = 50, range = {8, 1000} }
-- Three rows at least: the measures are those of the middle.
local columns = cdem.parameter{ name = "columns", default = math.min(5, count // 3), range = {2, math.min(30, count // 3)},
                                doc = "units in a row, of place; a third of count at most" }
local fineness = cdem.parameter{ name = "fineness", default = 3, range = {1.5, 30},
                                 doc = "height over the edge length of the tetrahedra" }
local seed = cdem.parameter{ name = "seed", default = 1, range = {0, 1e6}, doc = "of the attitudes" }
local held = cdem.parameter{ name = "held", default = 5, range = {1, 100}, doc = "how many of the lowest units are held" }
-- Units that fall have a large peak: of that a millionth is a pile that creeps.
local ratio = cdem.parameter{ name = "kinetic_energy_ratio", default = start == "drop" and 1e-8 or 1e-6,
                              range = {1e-12, 0.1}, doc = "of the largest there was: at rest" }
local friction = cdem.parameter{ name = "friction_angle", default = 35.0, range = {0, 80}, unit = "deg" }
local laying = cdem.parameter{ name = "laying_angle", default = 12.0, range = {0, 80}, unit = "deg",
                               doc = "with so much friction units are laid at rest" }
local sliding = cdem.parameter{ name = "sliding_angle", default = 15.0, range = {0, 80}, unit = "deg",
                                doc = "friction of what is laid while it settles, at most" }
local walls = cdem.parameter{ name = "walls", default = true, doc = "at the sides and the toe" }
local draw = cdem.parameter{ name = "pictures", default = true, doc = "draw them" }

-- Square bars: cut corners would make tetrahedra, and steps, a third of the size.
local solid = cdem.accropode{ mass = mass, density = set_up.density, width = 0.40, corner = 0 }
local height = solid.height
local unit = solid:mesh{ size = height / fineness }
local rows = math.ceil(count / columns)
local length = (rows * (start == "drop" and 0.9 or 0.55) + 2.5) * height
local bare = set_up.slope(length, (2 * columns + 3) * height * 0.62, height)

local pile
if start == "drop" then
  pile = cdem.drop{ unit = unit, count = count, onto = bare, seed = seed, layers = 3, gap = 0.05 * height }
else
  pile = cdem.place{ unit = unit, count = count, onto = bare, seed = seed, columns = columns, walls = walls,
                     friction_angle = laying }
end

local model, ground = set_up.model(pile, { length = length, friction_angle = friction, walls = walls })
local held_units = cdem.select.units{ body = "units", numbers = model:lowest_units{ body = "units", count = held } }
model:fix{ on = held_units }

local function picture(name, title, film)
  if draw then
    set_up.picture(model, ground, { file = name, title = title, colour = "unit", colour_bar = false, film = film })
  end
end
local units = string.format("%d units of %g t", count, mass / 1000)
picture("start.png", units .. (start == "drop" and ", before they fall" or ", laid"))
local frames = {}
local less_friction = start == "place" and sliding or nil
local settled = model:settle{ kinetic_energy_ratio = ratio, friction_angle = less_friction, every = 500, callback = function()
  if draw and start == "drop" then
    frames[#frames + 1] = string.format("frames/fall_%03d.png", #frames + 1)
    picture(frames[#frames], string.format("%s, %.1f s", units, model.time), true)
  end
end }
if #frames > 0 then cdem.film{ file = "fall.ogv", frames = frames, frames_per_second = 12 } end
picture("settled.png", units .. (start == "drop" and ", dropped and at rest" or ", laid and at rest"))

local now = model:pile{ body = "units" }
local ways = set_up.ways(pile:poses(), now:poses())
now:save{ file = "pile.json" }
model:save{ file = "settled.vtu" }

-- What the ground, the walls and the held units carry, less the ground's and the walls' own weight.
local weight = count * mass * (1 - set_up.water / set_up.density) * set_up.g
local carried = model:reaction(held_units)[3] - ground.weight
for _, name in ipairs(ground) do carried = carried + model:reaction(name)[3] end

local measures = model:pile_measures{ body = "units", onto = "slope" }
local few, is_held = 0, {}
for _, number in ipairs(model:lowest_units{ body = "units", count = held }) do is_held[number] = true end
for _, row in ipairs(measures.contacts) do
  if row.contacts < 3 and not is_held[row.unit] then few = few + 1 end
end
local contacts = model:contacts()
local table_of_the_maker = "maker's design table"
cdem.report{
  { name = "porosity", value = measures.porosity, reference = 0.5, kind = "paper", source = table_of_the_maker },
  { name = "units_per_area_times_Dn2", value = measures.units_per_area_times_dn2, reference = 0.645, kind = "paper",
    source = table_of_the_maker },
  { name = "thickness_over_height", value = measures.thickness / height, reference = 0.9, kind = "paper",
    source = table_of_the_maker },
  { name = "contacts_per_unit", value = measures.contacts_per_unit },
  { name = "fewest_contacts", value = measures.fewest_contacts },
  { name = "free_units_with_fewer_than_three", value = few },
  { name = "largest_way_over_height", value = math.max(table.unpack(ways)) / height },
  { name = "settle_kinetic_ratio", value = settled.kinetic_ratio },
  { name = "max_penetration_over_tet_height", value = contacts.deepest_over_tet_height },
  { name = "max_penetration_over_height", value = contacts.deepest / height, reference = 0, kind = "formula",
    source = "nothing passes through", tolerance_absolute = 0.01 },
  { name = "supports_carry_over_weight", value = carried / weight, reference = 1,
    kind = "formula", source = "balance of forces", tolerance = 0.01 },
  { name = "energy_balance_error", value = model:energy().balance_error },
  { name = "tets_per_unit", value = unit.tets },
  { name = "steps", value = settled.steps },
  { name = "wall_time_s", value = settled.wall_time },
}
