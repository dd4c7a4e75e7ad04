-- A slender block on a plane that leans more and more: it topples when its weight points past its edge, tan a = b / h.
--
--   ./cdem run examples/toppling/case.lua [--set width=0.3] [--set height=1.2]
local cdem = require "cdem"

local b = cdem.parameter{ name = "width", default = 0.5, range = {1e-2, 100}, unit = "m" }
local h = cdem.parameter{ name = "height", default = 1.5, range = {1e-2, 100}, unit = "m" }
local stiffness = cdem.parameter{ name = "normal_stiffness", default = 1e11, range = {1e8, 1e13}, unit = "Pa/m",
                                  doc = "of the contact, which sets the time step of rigid bodies" }

local stone = cdem.elastic{ youngs_modulus = 30e9, poissons_ratio = 0.2, density = 2500 }
local plate = cdem.solid.box{ size = {6 * b, 4 * b, 0.5 * b}, origin = {-3 * b, -2 * b, -0.5 * b} }:mesh{ size = b }
local block = cdem.solid.box{ size = {b, b, h}, origin = {-b / 2, -b / 2, 0} }:mesh{ size = b / 4 }
local g, swing = 9.81, math.sqrt(h / 9.81)

-- Does it fall over on a plane that leans by `angle`? The plane lies level and gravity leans instead.
local function topples(angle, picture)
  local model = cdem.model{
    bodies = { { shape = plate, material = stone, element = "rigid", name = "plate" },
               { shape = block, material = stone, element = "rigid", name = "block" } },
    contacts = { { "plate", "block", cdem.coulomb{ friction_angle = 60, normal_stiffness = stiffness } } },
  }
  model:fix{ on = "plate" }
  local function lean(degrees)
    model:gravity{ vector = {g * math.sin(math.rad(degrees)), 0, -g * math.cos(math.rad(degrees))} }
  end
  lean(0.9 * angle)
  model:run{ duration = 0.3 * swing, local_damping = 0.3 } -- it comes to stand
  lean(angle)
  local fell = false
  model:run{ duration = 20 * swing, stop = function()
    fell = model:max("displacement.magnitude", "block") > 0.3 * h
    return fell
  end }
  if picture and fell then
    model:picture{ file = picture, view = "iso", up = "z", colour = "displacement.magnitude", deformation = 1,
                   size = {1600, 0}, plain = {"plate"},
                   title = string.format("A slender block topples, gravity inclined by %.1f degrees", angle) }
  end
  return fell
end

local expected = math.deg(math.atan(b / h))
local stands, falls = 0.8 * expected, 1.2 * expected
for _ = 1, 6 do
  local middle = 0.5 * (stands + falls)
  if topples(middle, "toppling.png") then falls = middle else stands = middle end
end
cdem.report{ { name = "topples_at_degrees", value = 0.5 * (stands + falls), unit = "degrees", reference = expected,
               kind = "formula", source = "tan a = b / h", tolerance = 0.02 },
             { name = "found_to_degrees", value = 0.5 * (falls - stands), unit = "degrees" } }
