// Makes a chunk, edits it, meshes it and reads the quads. With the address of a server it also joins,
// meshes the world around the player, sets a voxel there and leaves.
//   mono sample.exe [HOST:PORT]
using System;
using System.Linq;
using Runstone;

internal static class Sample {
  private static void Hill() {
    using (Chunk chunk = Chunk.Filled(32, 32, 32, 0))  // 0 is empty
    using (Edits edits = Edits.Create())
    using (Visibility visibility = Visibility.Create())  // all materials are opaque
    using (Mesh mesh = Mesh.Create()) {
      for (int s = 0; s < 16; s += 2)
        edits.AddBox(new Pos(s, s, s), new Pos(32 - s, s + 2, 32 - s), Edits.Brush(1));
      ulong changed = chunk.Apply(new Pos(0, 0, 0), edits);
      mesh.Make(chunk, null, visibility);
      ulong[] quads = mesh.Quads(Pass.Opaque);
      Console.WriteLine("{0} voxels of stone, {1} quads", changed, quads.Length);
      foreach (QuadFields quad in quads.Take(3).Select(Mesh.Unpack))
        Console.WriteLine("{0} x {1} faces at {2} {3} {4}", quad.Width, quad.Height, quad.X, quad.Y,
                          quad.Z);
      Console.WriteLine("{0} vertices, {1} indices", mesh.Vertices(Pass.Opaque).Length,
                        mesh.Indices(Pass.Opaque).Length);
      // A chunk of stone on top hides the faces where the two touch.
      using (Chunk above = Chunk.Filled(32, 32, 32, 1)) {
        edits.Clear();
        edits.AddBox(new Pos(0, 31, 0), new Pos(32, 32, 32), Edits.Brush(1));
        chunk.Apply(new Pos(0, 0, 0), edits);
        mesh.Make(chunk, null, visibility);
        int alone = mesh.Quads(Pass.Opaque).Length;
        mesh.Make(chunk, new Chunk[] { null, null, null, above, null, null }, visibility);
        Console.WriteLine("{0} quads with a roof, {1} below stone", alone,
                          mesh.Quads(Pass.Opaque).Length);
      }
    }
  }

  private static void Refusals() {
    try {
      Chunk.Filled(4, 32, 32, 0);
    } catch (RunstoneException refused) {
      Console.WriteLine("refused: {0}", refused.Message);
    }
  }

  private static bool Join(string server) {
    using (Client client = Client.Connect(server, "Bjørn"))
    using (Edits edits = Edits.Create())
    using (Mesh mesh = Mesh.Create()) {
      int quads = 0;
      bool isSent = false;
      while (client.State != ClientState.Ended) {
        client.Wait(10);  // a game draws a frame instead
        client.Step();
        int index = 0;
        foreach (Event each in client.Drain(16)) {
          switch (each.Kind) {
            case EventKind.ChunkChanged:
              client.MakeMesh(index, mesh);  // replaces the mesh of each.At
              quads += mesh.Quads(Pass.Opaque).Length;
              break;
            case EventKind.EditConfirmed:
              Console.WriteLine("{0} quads; the edit is record {1}", quads, each.Sequence);
              return true;
            case EventKind.EditRejected:
            case EventKind.ConnectionLost:  // the client connects again by itself; the sample ends
              Console.WriteLine(client.Text(index));
              return false;
            default:
              string text = client.Text(index);  // such as a line of the chat
              if (text != "") Console.WriteLine(text);
              break;
          }
          ++index;
        }
        if (isSent || !client.IsComplete) continue;
        WorldInfo world = client.World;
        Console.WriteLine("chunks of {0} voxels; joined as {1}", world.ChunkEdge, world.NameText);
        Vec at = client.Place.At;
        edits.AddVoxel(new Pos((int)Math.Floor(at.X), (int)Math.Floor(at.Y), (int)Math.Floor(at.Z)),
                       Edits.Brush(1));
        client.Submit(edits, 0);
        isSent = true;
      }
      return false;
    }
  }

  private static int Main(string[] arguments) {
    Console.OutputEncoding = new System.Text.UTF8Encoding(false);
    Hill();
    Refusals();
    return arguments.Length == 0 || Join(arguments[0]) ? 0 : 1;
  }
}
