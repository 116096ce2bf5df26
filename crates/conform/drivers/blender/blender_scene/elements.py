"""Elements of Mitsuba's XML.

A value of a parameter is a number, a colour of three numbers (linear Rec. 709), or a texture, which is an element.
"""

import copy
import xml.etree.ElementTree as tree


def plugin(tag, kind, *children, **attributes):
    """An object of the scene, such as `<bsdf type="diffuse">`, with its parameters and parts; None among them is left out."""
    new = tree.Element(tag, {"type": kind, **attributes})
    new.extend(child for child in children if child is not None)
    return new


def text(number):
    """A number in as few digits as say it exactly, to single precision."""
    return f"{float(number):.9g}"


def numbers(values):
    """Several numbers."""
    return ", ".join(text(value) for value in values)


def simple(tag, name, value):
    """A parameter that is one word or number."""
    return tree.Element(tag, {"name": name, "value": value})


def integer(name, value):
    """A whole number."""
    return simple("integer", name, str(int(value)))


def boolean(name, value):
    """Yes or no."""
    return simple("boolean", name, "true" if value else "false")


def string(name, value):
    """A word, such as the name of a file."""
    return simple("string", name, value)


def parameter(name, value):
    """A parameter of whatever kind its value has; of a texture, a copy, so that it can be another one's as well."""
    if isinstance(value, tree.Element):
        value = copy.deepcopy(value)
        value.set("name", name)
        return value
    if isinstance(value, tuple):
        return simple("rgb", name, numbers(value))
    return simple("float", name, text(value))


def vector(name, values):
    """Three numbers that are no colour."""
    return simple("vector", name, numbers(values))


def radiance(value):
    """A parameter of what shines: a texture is lit by D65, as colours are of themselves."""
    if isinstance(value, tree.Element):
        value = plugin("spectrum", "d65", parameter("lit", value))
    return parameter("radiance", value)


def transform(name, rows):
    """A transform by the 16 numbers of its matrix."""
    new = tree.Element("transform", {"name": name})
    new.append(tree.Element("matrix", {"value": " ".join(text(value) for row in rows for value in row)}))
    return new


def reference(name):
    """A use of what has this id."""
    return tree.Element("ref", {"id": name})


def write(scene, path):
    """Writes the scene, indented."""
    tree.indent(scene)
    path.write_text(tree.tostring(scene, encoding="unicode") + "\n", encoding="utf-8")
