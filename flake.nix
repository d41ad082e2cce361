{
  description = "halflit: renders models to pictures on the CPU";

  inputs.nixpkgs.url = "nixpkgs";

  outputs = { self, nixpkgs }:
    let
      systems = [ "x86_64-linux" "aarch64-linux" ];
      for_each = make: nixpkgs.lib.genAttrs systems (system: make nixpkgs.legacyPackages.${system});
    in {
      packages = for_each (pkgs: {
        default = pkgs.callPackage ./packaging/nix/halflit.nix { source = self; };
      });
    };
}
