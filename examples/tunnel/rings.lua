-- Rings of blocks around a circular tunnel along y, and Kirsch's stresses around it.
local cdem = require "cdem"

local rings = {}

-- Sectors of rings that grow outwards from the wall, and wedges of the core.
function rings.blocks(a, outer, sectors, thickness)
  local radii, shapes = { 0, a }, {}
  while radii[#radii] < outer do radii[#radii + 1] = math.min(outer, radii[#radii] * (1 + 2.2 * math.pi / sectors)) end
  for i = 0, sectors - 1 do
    for ring = 1, #radii - 1 do
      local points = {}
      for _, r in ipairs{ radii[ring], radii[ring + 1] } do
        for k = i, r > 0 and i + 1 or i do
          for _, y in ipairs{ 0, thickness } do
            points[#points + 1] = { r * math.cos(2 * math.pi * k / sectors), y, r * math.sin(2 * math.pi * k / sectors) }
          end
        end
      end
      shapes[#shapes + 1] = cdem.convex_hull{ points = points }
    end
  end
  return cdem.merge{ shapes = shapes }, radii[3]
end

-- Hoop stress (Pa, tension positive) at r and angle from the horizontal, of a vertical stress -p and a horizontal one -k p.
function rings.kirsch(p, k, a, r, angle)
  local s = a / r
  return -0.5 * p * ((1 + k) * (1 + s ^ 2) + (1 - k) * (1 + 3 * s ^ 4) * math.cos(2 * angle))
end

-- Mean radial displacement of the wall, inwards, where the outer boundary (radius R) is fixed; p_mean: (1 + k) p / 2.
function rings.closure(p_mean, a, R, rock)
  local G, bulk = rock.shear_modulus, rock.p_wave_modulus - rock.shear_modulus -- lambda + G
  return p_mean / (2 * G / a ^ 2 + 2 * bulk / R ^ 2) * (1 / a - a / R ^ 2)
end

-- Mean of Kirsch's hoop stress over a sector of the first ring, and that of a block.
function rings.mean_hoop(p, k, a, far, angle, width)
  local sum, area = 0, 0
  for i = 1, 20 do
    local r = a + (far - a) * (i - 0.5) / 20
    for j = 1, 10 do
      sum = sum + r * rings.kirsch(p, k, a, r, angle + width * ((j - 0.5) / 10 - 0.5))
      area = area + r
    end
  end
  return sum / area
end
function rings.hoop(stress, angle)
  local c, s = math.cos(angle), math.sin(angle)
  return stress[1] * s * s + stress[3] * c * c - 2 * stress[6] * s * c
end

-- How far the wall has come in there, m.
function rings.towards(model, a, thickness, angle)
  local c, s = math.cos(angle), math.sin(angle)
  local at = { (a + 0.01) * c, thickness / 2, (a + 0.01) * s }
  return -model:at("displacement.x", at) * c - model:at("displacement.z", at) * s
end

-- The first ring of blocks over Kirsch: mean hoop stress, the worst block, and convergence.
function rings.beside_kirsch(model, t)
  local ratio, worst, closed, count = 0, 0, 0, 0
  for _, block in ipairs(model:blocks()) do
    local x, z = block.centroid[1], block.centroid[3]
    if x * x + z * z < t.far * t.far then
      local angle = math.atan(z, x)
      local one = rings.hoop(block.stress, angle) / rings.mean_hoop(t.p, t.k0, t.a, t.far, angle, 2 * math.pi / t.sectors)
      ratio, worst, count = ratio + one, math.max(worst, math.abs(one - 1)), count + 1
      closed = closed + rings.towards(model, t.a, t.thickness, angle)
    end
  end
  return { hoop = ratio / count, worst = worst,
           closure = closed / count / rings.closure(0.5 * (1 + t.k0) * t.p, t.a, t.outer, t.rock) }
end

return rings
