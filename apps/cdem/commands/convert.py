"""Reads a mesh by meshio and writes one that cdem reads: convert.py FROM TO. Called by `cdem convert`.

Tetrahedra (the corners alone of those of higher order) go into a .vtu with their numbers of region; triangles and
quadrangles into a .stl where there are no tetrahedra, or where the name TO asks for it.
"""
import sys


def refuse(line):
    sys.exit("cdem: error: " + line)


try:
    import meshio
    import numpy
except ImportError:
    refuse("python3-meshio is not installed: apt install python3-meshio")

# What the formats call the number of a region, the first that is there counts.
REGION = ["region", "gmsh:physical", "medit:ref", "nastran:ref", "cell_tags", "ElementBlockIds", "flac3d:group", "tetgen:ref", "avsucd:material"]


def corners(kind, data):
    """Tetrahedra or triangles of a block of cells, by their corners; None where it has none."""
    if kind.startswith("tetra"):
        return "tetra", data[:, :4]
    if kind in ("triangle", "triangle6", "triangle7"):
        return "triangle", data[:, :3]
    if kind in ("quad", "quad8", "quad9"):
        return "triangle", numpy.vstack([data[:, [0, 1, 2]], data[:, [0, 2, 3]]])
    return None


def regions(mesh, block, rows):
    """A number for each cell of a block: cell data, else cell sets by name, else 0."""
    for name in REGION:
        if name in mesh.cell_data:
            values = numpy.asarray(mesh.cell_data[name][block]).astype(int).ravel()
            return numpy.tile(values, rows // max(1, len(values)))
    numbers = numpy.zeros(rows, dtype=int)
    for number, (name, sets) in enumerate(sorted(mesh.cell_sets.items()), start=1):
        if sets[block] is not None and not name.startswith("gmsh:"):
            numbers[numpy.asarray(sets[block], dtype=int)] = number
    return numbers


def main(source, target):
    try:
        mesh = meshio.read(source)
    except SystemExit:  # meshio ends the interpreter where it knows no format
        refuse(f"{source}: meshio knows no format with this ending, or the file is damaged")
    except ImportError as error:
        refuse(f"{source}: meshio needs another package for this format: apt install python3-{error.name}")
    except Exception as error:
        refuse(f"{source}: {' '.join(str(error).split()) or type(error).__name__}")
    found, numbers, other = {"tetra": [], "triangle": []}, {"tetra": [], "triangle": []}, {}
    for block, cells in enumerate(mesh.cells):
        taken = corners(cells.type, numpy.asarray(cells.data))
        if taken is None:
            other[cells.type] = other.get(cells.type, 0) + len(cells.data)
            continue
        found[taken[0]].append(taken[1])
        numbers[taken[0]].append(regions(mesh, block, len(taken[1])))
    kind = "triangle" if target.endswith(".stl") or not found["tetra"] else "tetra"
    if not found[kind]:
        refuse(f"{source}: no {'triangles' if kind == 'triangle' else 'tetrahedra'}; it has "
                 + (", ".join(f"{count} {name}" for name, count in other.items()) or "no cells"))
    if kind == "triangle" and not target.endswith(".stl"):
        refuse(f"{source}: a surface without tetrahedra; name a .stl as what to write")
    cells, region = numpy.vstack(found[kind]), numpy.concatenate(numbers[kind])
    points = numpy.zeros((len(mesh.points), 3))
    points[:, : mesh.points.shape[1]] = mesh.points
    used, cells = numpy.unique(cells, return_inverse=True)
    cells = cells.reshape(-1, 4 if kind == "tetra" else 3)
    data = {"region": [region]} if kind == "tetra" else {}
    meshio.write(target, meshio.Mesh(points[used], [(kind, cells)], cell_data=data), **({"compression": None} if kind == "tetra" else {}))
    left = ", ".join(f"{count} {name}" for name, count in other.items() if name not in ("vertex", "line", "line3"))
    print(f"{target}: {len(cells)} {'tetrahedra' if kind == 'tetra' else 'triangles'}, {len(used)} nodes"
          + (f", regions {', '.join(map(str, numpy.unique(region)))}" if kind == "tetra" else "")
          + (f"; left out: {left}" if left else ""))


main(sys.argv[1], sys.argv[2])
