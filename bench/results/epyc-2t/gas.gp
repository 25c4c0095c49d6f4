# Draws gas.png: gnuplot gas.gp
if (!exists('ending')) ending = ''
if (strstrt(GPVAL_TERMINALS, 'pngcairo') > 0) {
    set terminal pngcairo size 1100,700 font 'DejaVu Sans,14' background 'white'
} else {
    set terminal png size 1100,700
}
set encoding utf8
set datafile missing 'nan'
set grid linetype 1 linecolor '#c8c8c8' linewidth 1
set border linecolor '#404040'
set key outside right top Left reverse noenhanced
set tics nomirror
set format y '%g'
set style line 1 linecolor '#0072B2' linewidth 2 pointtype 7 pointsize 2.2
set style line 2 linecolor '#D55E00' linewidth 2 pointtype 5 pointsize 1.7
set style line 3 linecolor '#009E73' linewidth 2 pointtype 9 pointsize 1.7
set output 'gas.png'.ending
set title 'Suite gas: rates over those of Embree by itself'
set key outside top center horizontal
set ylabel 'ratio'
set style fill solid 0.85 noborder
set grid noxtics
set boxwidth 0.25
set yrange [0:*]
set offsets 0,0,graph 0.05,0
set xtics ('gas-20k' 0, 'gas-1300k' 1) rotate by -30 noenhanced
set xrange [-0.6:1.6]
$numbers << EOD
"gas-20k" 2.67968 1.43097 3.01098
"gas-1300k" 2.27996 1.00074 2.65707
EOD
plot $numbers using ($0+(-0.25)):2 with boxes linestyle 1 title 'particle-steps / bare rays', \
     $numbers using ($0+(-0.25)):2:(sprintf('%.2g',column(2))) with labels offset 0,0.6 font ',10' notitle, \
     $numbers using ($0+(0)):3 with boxes linestyle 2 title 'particle-steps / sorted packets of rays', \
     $numbers using ($0+(0)):3:(sprintf('%.2g',column(3))) with labels offset 0,0.6 font ',10' notitle, \
     $numbers using ($0+(0.25)):4 with boxes linestyle 3 title 'impacts / native bounces', \
     $numbers using ($0+(0.25)):4:(sprintf('%.2g',column(4))) with labels offset 0,0.6 font ',10' notitle, \
     1 with lines linecolor '#404040' dashtype 2 notitle
set output
