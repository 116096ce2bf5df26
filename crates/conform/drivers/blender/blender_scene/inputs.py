"""Inputs of shader nodes, through groups and reroutes.

An `Input` is a socket and the groups that it is in: the same group has other inputs at each of its uses.
"""

import bpy


class Input:
    """An input of a node."""

    def __init__(self, socket, groups=()):
        self.socket, self.groups = socket, groups

    def source(self):
        """The node and the output that feed this input; None where there is none."""
        socket, groups = self.socket, self.groups
        while True:
            links = [link for link in socket.links if not link.is_muted] if socket.is_linked else []
            if not links:
                self.socket, self.groups = socket, groups  # whose value stands in
                return None
            node, output = links[0].from_node, links[0].from_socket
            if node.bl_idname == "NodeReroute":
                socket = node.inputs[0]
            elif node.bl_idname == "ShaderNodeGroup" and node.node_tree:
                ends = [end for end in node.node_tree.nodes if end.bl_idname == "NodeGroupOutput" and end.is_active_output]
                if not ends:
                    return None
                groups += (node,)
                socket = next(end for end in ends[0].inputs if end.identifier == output.identifier)
            elif node.bl_idname == "NodeGroupInput" and groups:
                socket = next(end for end in groups[-1].inputs if end.identifier == output.identifier)
                groups = groups[:-1]
            else:
                return Node(node, output, groups)

    def constant(self):
        """The value that it has where nothing feeds it: a number or a colour."""
        value = getattr(self.socket, "default_value", 0.0)
        if self.socket.type in ("RGBA", "VECTOR"):
            return tuple(value)[:3]
        return float(value) if isinstance(value, (int, float)) else 0.0


class Node:
    """A node, the output that is asked for, and the groups that it is in."""

    def __init__(self, node, output, groups=()):
        self.node, self.output, self.groups = node, output, groups
        self.kind = node.bl_idname.removeprefix("ShaderNode")

    def __getitem__(self, key):
        """An input by its name or number; of inputs that are shown in some modes only, the one that is in use."""
        if isinstance(key, str):
            found = [socket for socket in self.node.inputs if socket.name == key]
            used = [socket for socket in found if socket.enabled]
            return Input((used or found)[0], self.groups)
        return Input(self.node.inputs[key], self.groups)

    def __contains__(self, key):
        return key in self.node.inputs

    def where(self, material):
        """How a note names it."""
        return f"{material}, node {self.node.name}"


def uses_nodes(data):
    """Whether a material, a world or a light has nodes that count; from Blender 5.0 on all materials and worlds have."""
    if bpy.app.version >= (5, 0) and not isinstance(data, bpy.types.Light):
        return data.node_tree is not None
    return data.use_nodes and data.node_tree is not None


def output(data, target):
    """The input of this name at the end of a material's, world's or light's nodes that Cycles would use; None without nodes."""
    end = data.node_tree.get_output_node("CYCLES") if uses_nodes(data) else None
    return Node(end, None)[target] if end else None
