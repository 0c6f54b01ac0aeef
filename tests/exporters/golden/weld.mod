MODULE weld_Mod
  ! RAPID by irlx 0.1.0: a joint stream with a tick of 20 ms
  ! program weld.irl
  ! sha256 abababababababababababababababababababababababababababababababab
  ! robot arm, tip link7, cell cell.toml
  ! rax_1 is A2
  ! rax_2 is A3
  ! rax_3 is A4
  ! rax_4 is A5
  ! rax_5 is A6
  ! rax_6 is A7
  ! eax_a is A1
  ! T is the time of the stream; what the controller cannot do in it takes longer.
  ! z0 passes near the points, not through them.
  PROC weld()
    MoveAbsJ [[0.00000000,57.29577951,114.59155903,171.88733854,229.18311805,286.47889757],[500.00000000,9E9,9E9,9E9,9E9,9E9]]\NoEOffs, v100, fine, tool0;
    MoveAbsJ [[5.72957795,57.29577951,114.59155903,171.88733854,229.18311805,286.47889757],[600.00000000,9E9,9E9,9E9,9E9,9E9]]\NoEOffs, v1000\T:=0.02, z0, tool0;
    MoveAbsJ [[11.45915590,57.29577951,114.59155903,171.88733854,229.18311805,-28.64788976],[700.00000000,9E9,9E9,9E9,9E9,9E9]]\NoEOffs, v1000\T:=0.02, fine, tool0;
    WaitTime 0.02;
    ! end of the stream: 4 samples, complete
  ENDPROC
ENDMODULE
